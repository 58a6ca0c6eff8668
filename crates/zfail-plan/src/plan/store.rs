//! Index lists side by side in one array that outlives frames.
//!
//! In: lists that changed. Out: where each lies, and which ranges of the array have to be uploaded. A list that grows
//! beyond its place moves to the end; once most of the array is abandoned, everything is laid out afresh.

use std::ops::Range;

/// Where a list lies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    start: u32,
    capacity: u32,
    /// Layout in which it was placed; 0 is none.
    layout: u32,
}

/// The array's bookkeeping; the array itself belongs to the plan.
#[derive(Debug)]
pub(super) struct Store {
    layout: u32,
    /// Indices in places that are in use.
    live: usize,
}

impl Default for Store {
    fn default() -> Self {
        Self { layout: 1, live: 0 }
    }
}

impl Store {
    /// Begins a frame: lays everything out afresh if more than half of the array is abandoned.
    pub fn begin(&mut self, indices: &mut Vec<u32>, changed: &mut Vec<Range<u32>>) {
        /// Too little to be worth it.
        const SMALL: usize = 1 << 16;
        changed.clear();
        if indices.len() > 2 * self.live + SMALL {
            self.layout += 1;
            self.live = 0;
            indices.clear();
        }
    }

    /// Puts `list`, `offset` added to each index, into the array (`fresh`: it is not what was put there before) and returns
    /// where it starts; `None` if the array would outgrow 32 bits.
    pub fn put(
        &mut self,
        place: &mut Place,
        list: &[u32],
        offset: u32,
        fresh: bool,
        indices: &mut Vec<u32>,
        changed: &mut Vec<Range<u32>>,
    ) -> Option<u32> {
        let placed = place.layout == self.layout;
        if placed && !fresh {
            return Some(place.start);
        }
        let length = u32::try_from(list.len()).ok()?;
        if !placed || length > place.capacity {
            self.release(place);
            // Room to grow, for a silhouette under a moving light is never twice as long.
            let capacity = length.checked_add(length / 4)?;
            let start = u32::try_from(indices.len()).ok()?;
            let end = start.checked_add(capacity)?;
            indices.resize(end as usize, 0);
            *place = Place { start, capacity, layout: self.layout };
            self.live += capacity as usize;
        }
        let range = place.start..place.start + length;
        let there = &mut indices[range.start as usize..range.end as usize];
        there.iter_mut().zip(list).for_each(|(index, i)| *index = i + offset);
        match changed.last_mut() {
            Some(last) if last.end <= range.start && range.start - last.end <= 64 => last.end = range.end,
            _ => changed.push(range),
        }
        Some(place.start)
    }

    /// Gives a place up.
    pub fn release(&mut self, place: &mut Place) {
        if place.layout == self.layout {
            self.live -= place.capacity as usize;
        }
        *place = Place::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_stay_grow_and_are_compacted() {
        let (mut store, mut indices, mut changed) = (Store::default(), Vec::new(), Vec::new());
        let mut places = [Place::default(); 2];
        let mut put = |store: &mut Store, p: &mut Place, list: &[u32], fresh| {
            store.put(p, list, 0, fresh, &mut indices, &mut changed).map(|at| (at, changed.clone(), indices.clone()))
        };
        let (at, _, _) = put(&mut store, &mut places[0], &[1, 2, 3, 4], true).expect("room");
        assert_eq!(at, 0);
        let (at, changed_now, all) = put(&mut store, &mut places[1], &[7; 8], true).expect("room");
        assert_eq!((at, &all[5..13]), (5, &[7; 8][..]));
        assert_eq!((changed_now.len(), &changed_now[0]), (1, &(0..13)));
        // Unchanged lists stay, shorter ones too, longer ones move.
        assert_eq!(put(&mut store, &mut places[0], &[1, 2, 3, 4], false).map(|p| p.0), Some(0));
        assert_eq!(put(&mut store, &mut places[0], &[9], true).map(|p| p.0), Some(0));
        assert_eq!(put(&mut store, &mut places[0], &[9; 6], true).map(|p| p.0), Some(15));
        let mut changed = Vec::new();
        let mut large = vec![0; 100_000];
        store.begin(&mut large, &mut changed);
        assert!(large.is_empty());
        assert_eq!(store.put(&mut places[1], &[5; 8], 2, false, &mut large, &mut changed), Some(0), "placed afresh");
        assert_eq!((changed.len(), &changed[0], &large[..8]), (1, &(0..8), &[7; 8][..]));
    }
}
