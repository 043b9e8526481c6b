//! Maps in the order of their keys.

use std::collections::BTreeMap;

/// Makes a map by inserting entries one by one, so that the last entry with a key counts. `collect` would
/// sort them first, with separate code for every type of entries: 40 kB and more of the module that the page
/// without a server loads.
///
/// ```
/// use slipfront_base::ordered::map_of;
/// let map = map_of([('b', 1), ('a', 2), ('b', 3)]);
/// assert_eq!(Vec::from_iter(map), [('a', 2), ('b', 3)]);
/// ```
pub fn map_of<K: Ord, V>(entries: impl IntoIterator<Item = (K, V)>) -> BTreeMap<K, V> {
    let mut map = BTreeMap::new();
    map.extend(entries);
    map
}
