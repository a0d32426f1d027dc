//! Names of temporary files. They contain the host, because the locks in a shared folder may be visible on one host only.

/// A temporary file's name is this, the host's name, [`DELIMITER`], and [`RANDOM`] letters and digits.
const PREFIX: &str = ".whiskmap-";

/// No host's name has this character.
const DELIMITER: char = '+';

/// Length of the random end of a name.
pub const RANDOM: usize = 12;

/// Returns the name of a temporary file of this host, but for the random end.
pub fn prefix() -> String {
    format!("{PREFIX}{}{DELIMITER}", host())
}

/// Returns the host in the name of a temporary file; `None` for any other name.
pub fn host_of(name: &str) -> Option<&str> {
    let (host, random) = name.strip_prefix(PREFIX)?.split_once(DELIMITER)?;
    let is_random = random.len() == RANDOM && random.chars().all(|c| c.is_ascii_alphanumeric());
    (is_random && host.chars().all(is_of_host)).then_some(host)
}

/// Returns true for the characters of a host's name.
fn is_of_host(c: char) -> bool {
    c.is_ascii_alphanumeric() || "-_.".contains(c)
}

/// Returns the name of this host.
pub fn host() -> String {
    #[cfg(unix)]
    let host = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    #[cfg(not(unix))]
    let host = std::env::var("COMPUTERNAME").unwrap_or_default();
    host.chars().filter(|c| is_of_host(*c)).take(64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_exact_names_have_a_host() {
        let named = |name: &str| host_of(name).map(str::to_owned);
        let host = |name: &str| Some(name.to_owned());
        assert_eq!(named(".whiskmap-node+aB3dE6gH9jK2"), host("node"));
        assert_eq!(
            named(".whiskmap-node-2.org+aB3dE6gH9jK2"),
            host("node-2.org")
        );
        for foreign in [
            ".whiskmap-node-notes.txt",
            ".whiskmap-node+notes.txt",
            ".whiskmap-node+aB3dE6gH9jK",
            ".whiskmap-node+aB3dE6gH9jK2x",
            ".whiskmap-node+aB3dE6gH9jK.",
            ".whiskmap-my node+aB3dE6gH9jK2",
            ".whiskmap-node+x+aB3dE6gH9jK2",
            "whiskmap-node+aB3dE6gH9jK2",
            ".whiskmap-",
        ] {
            assert_eq!(named(foreign), None, "{foreign}");
        }
    }
}
