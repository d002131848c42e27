//! OpenEXR images: the sea that a render carries in its header. Pixels are never read.

use exr::meta::MetaData;
use exr::meta::attribute::AttributeValue;
use std::io::Read;

/// The first bytes of every OpenEXR file.
pub const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// The attribute that holds the sea, as TOML.
pub const ATTRIBUTE: &str = "prob_water";
/// Headers have thumbnails at most; what is longer than this many bytes is none.
const LONGEST_HEADER: u64 = 1 << 24;
/// Of attributes that are there instead, so many are named.
const NAMED: usize = 12;

/// The text of the attribute, from the first of the image's parts that has it.
pub fn sea(image: impl Read) -> Result<Vec<u8>, String> {
    let header = MetaData::read_from_buffered(image.take(LONGEST_HEADER), false)
        .map_err(|e| format!("the header of this OpenEXR image cannot be read: {e}"))?;
    let attributes = || header.headers.iter().flat_map(|part| &part.own_attributes.other);
    match attributes().find(|(name, _)| name.as_slice() == ATTRIBUTE.as_bytes()) {
        Some((_, AttributeValue::Text(text))) => Ok(text.as_slice().to_vec()),
        Some(_) => Err(format!("the attribute {ATTRIBUTE} is not text")),
        None => {
            let mut names: Vec<_> = attributes().map(|(name, _)| shown(&name.to_string())).collect();
            names.sort();
            let more = names.len().saturating_sub(NAMED);
            names.truncate(NAMED);
            let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            let more = if more == 0 { String::new() } else { format!(" and {more} more") };
            Err(format!("this OpenEXR image has no attribute {ATTRIBUTE}; its own are {names}{more}"))
        }
    }
}

/// A name that fits into a message.
fn shown(name: &str) -> String {
    name.chars().take(40).flat_map(char::escape_default).collect()
}
