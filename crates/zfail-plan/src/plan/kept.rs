//! A value beside what it was made for.

/// A value that is made anew, in the memory of the old one, when it is asked for something else.
#[derive(Clone, Debug)]
pub(super) struct Kept<K, V> {
    key: Option<K>,
    value: V,
}

impl<K, V: Default> Default for Kept<K, V> {
    fn default() -> Self {
        Self { key: None, value: V::default() }
    }
}

impl<K: PartialEq, V> Kept<K, V> {
    /// Whether the value was made for `key`.
    pub fn is_for(&self, key: &K) -> bool {
        self.key.as_ref() == Some(key)
    }

    /// The value as it is, whatever it was made for.
    pub fn value(&self) -> &V {
        &self.value
    }

    /// The same, to be changed in a way that `key` does not tell.
    pub fn value_mut(&mut self) -> &mut V {
        &mut self.value
    }

    /// The value for `key`, which `make` brings about if it is not there.
    pub fn get(&mut self, key: K, make: impl FnOnce(&mut V)) -> &V {
        if !self.is_for(&key) {
            // If `make` panics, the half-made value is for nothing.
            self.key = None;
            make(&mut self.value);
            self.key = Some(key);
        }
        &self.value
    }
}

#[cfg(test)]
mod tests {
    use super::Kept;

    #[test]
    fn it_is_made_once_for_each_key_in_turn() {
        let (mut kept, mut made) = (Kept::<u32, Vec<u32>>::default(), 0);
        for (key, times) in [(1, 1), (1, 1), (2, 2), (1, 3)] {
            let value = kept.get(key, |value| {
                made += 1;
                value.clear();
                value.push(10 * key);
            });
            assert_eq!((value.as_slice(), made), ([10 * key].as_slice(), times));
            assert!(kept.is_for(&key) && !kept.is_for(&(key + 1)));
        }
    }
}
