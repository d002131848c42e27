//! `[[engagement]]` of a scenario file: one time, or a trajectory.

use crate::toml_file::Item;
use prob_water::{Aim, Beam, Engagement, Error};

const KEYS: [&str; 9] =
    ["time", "times", "laser", "target", "direction", "observers", "divergence", "aperture", STOKES];
/// The one that says how the beam is polarised.
pub const STOKES: &str = "stokes";

/// The engagements of one entry, one for every time, s; `now` is the time where none is given.
pub fn read(entry: &Item, now: f64) -> Result<Vec<Engagement>, String> {
    let items = entry.table()?;
    if let Some(unknown) = items.iter().find(|item| !KEYS.contains(&item.name)) {
        return Err(unknown.refuse(format!("unknown key {}: known are {}", unknown.name, KEYS.join(", "))));
    }
    let find = |name: &str| items.iter().find(|item| item.name == name);
    let need = |name: &str| find(name).ok_or_else(|| entry.refuse(format!("{name} is missing")));

    let (times, count) = match (find("time"), find("times")) {
        (Some(_), Some(times)) => return Err(times.refuse("time and times are both given")),
        (_, Some(list)) => {
            let times: Vec<_> =
                list.list("a list of times")?.iter().map(Item::number).collect::<Result<_, _>>()?;
            if times.is_empty() {
                return Err(list.refuse("times is empty"));
            }
            let count = times.len();
            (times, Some(count))
        }
        (time, None) => (vec![time.map_or(Ok(now), Item::number)?], None),
    };
    let laser = track(need("laser")?, count)?;
    let (aim, way): (fn([f64; 3]) -> Aim, _) = match (find("target"), find("direction")) {
        (Some(_), Some(direction)) => return Err(direction.refuse("target and direction are both given")),
        (Some(target), None) => (Aim::Target, track(target, count)?),
        (None, Some(direction)) => (Aim::Direction, track(direction, count)?),
        (None, None) => return Err(entry.refuse("target or direction is missing")),
    };
    let observers = need("observers")?.list("a list of positions")?;
    let observers = observers.iter().map(|o| track(o, count)).collect::<Result<Vec<_>, _>>()?;
    let beam = match (find("divergence"), find("aperture")) {
        (None, Some(aperture)) => return Err(aperture.refuse("aperture has no meaning without divergence")),
        (None, None) => None,
        (Some(divergence), aperture) => Some((divergence.number()?, aperture.map_or(Ok(0.0), Item::number)?)),
    };
    let stokes = find(STOKES).map(stokes).transpose()?;

    let at = |(i, time): (usize, &f64)| {
        let observers: Vec<_> = observers.iter().map(|track| track[i]).collect();
        let mut engagement = Engagement::new(*time, laser[i], aim(way[i]), &observers)?;
        if let Some(stokes) = stokes {
            engagement = engagement.with_stokes(stokes)?;
        }
        Ok(match beam {
            Some((divergence, aperture)) => engagement.with_beam(Beam::new(divergence, aperture)?),
            None => engagement,
        })
    };
    // The library refuses by name: the line is that of the key.
    let refuse = |error: Error| {
        let Some(parameter) = error.parameters().first().copied() else { return entry.refuse(error) };
        let given = find(parameter).or_else(|| find("times").filter(|_| parameter == "time"));
        given.unwrap_or(entry).refuse(error)
    };
    times.iter().enumerate().map(at).collect::<Result<_, _>>().map_err(refuse)
}

/// The four numbers of a Stokes vector.
fn stokes(item: &Item) -> Result<[f64; 4], String> {
    let numbers = item.list("[I, Q, U, V]")?.iter().map(Item::number).collect::<Result<Vec<_>, _>>()?;
    numbers.try_into().map_err(|_| item.refuse("stokes is not [I, Q, U, V]"))
}

/// Positions, one for every time: a fixed one repeats. `count` is that of a trajectory's times.
fn track(item: &Item, count: Option<usize>) -> Result<Vec<[f64; 3]>, String> {
    let name = item.name;
    let parts = item.list("[x, y, z]")?;
    if parts.first().is_none_or(|part| part.parts().is_none()) {
        return Ok(vec![item.position()?; count.unwrap_or(1)]);
    }
    match count {
        None => Err(item.refuse(format!("{name} lists positions, one for every time: that needs times"))),
        Some(count) if count != parts.len() => {
            Err(item.refuse(format!("{name} lists {} positions for {count} times", parts.len())))
        }
        Some(_) => parts.iter().map(Item::position).collect(),
    }
}
