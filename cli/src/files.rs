//! Where rows go: standard output, or files that appear whole or not at all.

use crate::{Outcome, Stop};
use clap::ArgMatches;
use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, IsTerminal, Stdout, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use tempfile::NamedTempFile;

/// A file in the making, or standard output.
pub struct Destination {
    /// As given, for messages; `None` is standard output.
    given: Option<PathBuf>,
    out: Out,
}

enum Out {
    Standard(Stdout),
    /// A device or a pipe, written as it is.
    Device(File),
    Temporary {
        file: NamedTempFile,
        path: PathBuf,
        permissions: Option<Permissions>,
    },
}

/// The files in the making, which Ctrl-C removes.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
/// What Ctrl-C says, if anything.
static LAST_WORDS: Mutex<String> = Mutex::new(String::new());

impl Destination {
    /// Standard output where no path is given.
    pub fn open(path: Option<&Path>) -> Result<Self, Stop> {
        let Some(path) = path else {
            return Ok(Self { given: None, out: Out::Standard(io::stdout()) });
        };
        let out = open(path).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
        Ok(Self { given: Some(path.to_owned()), out })
    }

    /// What to make of an error in writing: whoever reads standard output may stop early.
    pub fn stop(&self, error: io::Error) -> Stop {
        match &self.given {
            None if error.kind() == ErrorKind::BrokenPipe => Stop::ReaderLeft,
            None => Stop::Refused(format!("cannot write to standard output: {error}")),
            Some(path) => Stop::Refused(format!("cannot write {}: {error}", path.display())),
        }
    }
}

impl Write for Destination {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.out {
            Out::Standard(out) => out.write(bytes),
            Out::Device(out) => out.write(bytes),
            Out::Temporary { file, .. } => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.out {
            Out::Standard(out) => out.flush(),
            Out::Device(out) => out.flush(),
            Out::Temporary { file, .. } => file.flush(),
        }
    }
}

/// Lets the files appear, now that all of them are whole.
pub fn keep(destinations: Vec<Destination>) -> Outcome {
    // Ctrl-C has to wait: it comes before the first or after the last.
    let _all = TEMPORARIES.lock().unwrap();
    for destination in destinations {
        let Destination { given: Some(given), out: Out::Temporary { file, path, permissions } } = destination
        else {
            continue;
        };
        permissions
            .map_or(Ok(()), |permissions| file.as_file().set_permissions(permissions))
            .and_then(|()| file.persist(path).map_err(|e| e.error))
            .map_err(|e| format!("cannot write {}: {e}", given.display()))?;
    }
    Ok(())
}

/// Lets Ctrl-C say something before it ends the run.
pub fn on_interrupt(last_words: String) {
    *LAST_WORDS.lock().unwrap() = last_words;
    handle_interrupts();
}

/// The first call holds for good.
fn handle_interrupts() {
    let _ = ctrlc::set_handler(|| {
        for path in TEMPORARIES.lock().unwrap().iter() {
            let _ = fs::remove_file(path);
        }
        let words = LAST_WORDS.lock().unwrap();
        if !words.is_empty() {
            // Below the bar, which has no end of line.
            let start = if io::stderr().is_terminal() { "\n" } else { "" };
            eprintln!("{start}prob-water: {words}");
        }
        std::process::exit(130);
    });
}

/// Through a link to the file itself, as an ordinary write would.
pub fn resolve(path: &Path) -> PathBuf {
    fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned())
}

/// The flags that name files to write.
const OUTPUTS: [&str; 2] = ["output", "instances_out"];

/// Refuses outputs that are a file to be read, by whatever name; `-` is standard input.
pub fn apart<'p>(matches: &ArgMatches, inputs: impl IntoIterator<Item = &'p Path>) -> Result<(), String> {
    let outputs = OUTPUTS.map(|flag| Some((flag, matches.try_get_one::<PathBuf>(flag).ok()??)));
    let outputs: Vec<_> = outputs.into_iter().flatten().filter(|(_, path)| *path != Path::new("-")).collect();
    for input in inputs {
        let (read, name) = match input.to_str() {
            Some("-") => (Path::new("/dev/stdin"), "standard input".into()),
            _ => (input, input.display().to_string()),
        };
        if let Some((flag, path)) = outputs.iter().find(|(_, path)| same(path, read)) {
            let (flag, path) = (flag.replace('_', "-"), path.display());
            return Err(format!("--{flag} = {path} is also read, as {name}: allowed is another file"));
        }
    }
    Ok(())
}

/// Whether two names, through links of either kind, are those of one file; devices and pipes are none.
fn same(a: &Path, b: &Path) -> bool {
    let [Ok(one), Ok(other)] = [a, b].map(fs::metadata) else { return false };
    #[cfg(unix)]
    let identical = {
        use std::os::unix::fs::MetadataExt;
        (one.dev(), one.ino()) == (other.dev(), other.ino())
    };
    #[cfg(not(unix))]
    let identical = resolve(a) == resolve(b);
    one.is_file() && other.is_file() && identical
}

fn open(path: &Path) -> io::Result<Out> {
    let path = resolve(path);
    let old = fs::metadata(&path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        return Ok(Out::Device(File::options().write(true).open(path)?));
    }
    handle_interrupts();
    let folder = path.parent().unwrap_or(Path::new("/"));
    fs::metadata(folder)?; // else the message would name the temporary file
    let mut all = TEMPORARIES.lock().unwrap();
    let file = temporary_file(folder)?;
    all.push(file.path().to_owned());
    Ok(Out::Temporary { file, path, permissions: old.map(|old| old.permissions()) })
}

/// In the folder of the final file, so that a rename suffices, with a new file's usual permissions.
fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".prob-water-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
