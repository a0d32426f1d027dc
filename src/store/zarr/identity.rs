//! Identities of a store and of its files: hashes of everything that their bytes depend on.

use crate::store::attributes::{DIGITS, sorted};
use serde_json::{Map, Value};
use twox_hash::XxHash3_128;

/// Name of the attribute with the identity of the store.
pub(super) const IDENTITY: &str = "identity";

/// The attributes in which all runs that fill a store must agree; the first that differs is named.
pub(super) const AGREED: [&str; 7] =
    ["whiskmap_version", "engine", "arithmetic", "tolerances", "channels", "scene", DIGITS];

/// Identity of a store: the XXH3-128 hash of the attributes in which all runs that fill it agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct StoreIdentity(u128);

/// Identity of a block's file: its first bytes, a hash of the store's identity, the array and the file's name.
pub(super) type FileIdentity = [u8; 16];

impl StoreIdentity {
    /// Returns the identity of a store with these attributes.
    pub(super) fn of(attributes: &Map<String, Value>) -> Self {
        let agreed = AGREED.iter().filter_map(|name| attributes.get(*name));
        let agreed: Vec<Value> = agreed.map(sorted).collect();
        let text = serde_json::json!(agreed).to_string();
        Self(XxHash3_128::oneshot(text.as_bytes()))
    }

    /// Returns the identity of the store as 32 hexadecimal digits.
    pub(super) fn text(self) -> String {
        format!("{:032x}", self.0)
    }

    /// Returns the identity of the file `name` of the array `array`.
    pub(super) fn of_file(self, array: &str, name: &str) -> FileIdentity {
        let text = format!("{}/{array}/{name}", self.text());
        XxHash3_128::oneshot(text.as_bytes()).to_le_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn attributes(scene: &str) -> Map<String, Value> {
        let tolerances = json!({ "b": 1, "a": 2 });
        let all = [("scene", json!(scene)), ("tolerances", tolerances)];
        Map::from_iter(all.map(|(name, value)| (name.to_owned(), value)))
    }

    #[test]
    fn what_is_agreed_on_changes_it_and_nothing_else_does() {
        let one = StoreIdentity::of(&attributes("one"));
        let mut titled = attributes("one");
        titled.insert("title".to_owned(), json!("One"));
        assert_eq!(one, StoreIdentity::of(&titled));
        for name in AGREED {
            let mut other = titled.clone();
            other.insert(name.to_owned(), json!("two"));
            assert_ne!(one, StoreIdentity::of(&other), "{name}");
        }
        let files = [("regime", "c.0"), ("regime", "c.1"), ("status", "c.0")];
        let [a, b, c] = files.map(|(array, name)| one.of_file(array, name));
        assert!(a != b && b != c && c != a);
    }
}
