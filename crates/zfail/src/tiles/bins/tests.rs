use super::*;

const SIZE: [u32; 2] = [100, 60];
const FULL: Rectangle = [0, 0, 100, 60];

/// The list of every tile, by x and y.
fn lists(bins: &mut Bins) -> Vec<([u32; 2], Vec<u32>)> {
    let (mut entries, mut groups, mut places) = (vec![7; 3], Vec::new(), vec![NO_TILE; LANES]);
    bins.append(&mut entries, &mut groups, &mut places);
    let places = places.split_off(LANES);
    assert_eq!(places.len(), groups.len() * LANES);
    let list = |(i, place): (usize, &u32)| {
        let Group { first, length } = groups[i / LANES];
        let at = (0..length as usize).map(|k| first as usize + k * LANES + i % LANES);
        let list = at.map(|at| entries[at]).filter(|&quad| quad != 0).collect();
        ([place & 0xffff, place >> 16], list)
    };
    places.iter().enumerate().filter(|(_, place)| **place != NO_TILE).map(list).collect()
}

fn bins() -> Bins {
    let mut bins = Bins::default();
    bins.clear(SIZE);
    bins
}

#[test]
fn every_pixel_centre_inside_finds_its_polygon() {
    let mut random = zfail_testing::Random(1);
    let mut coordinate = |extent: u32| random.real(-0.5, 1.5) * f64::from(extent);
    let triangles: Vec<[DVec2; 3]> =
        (0..200).map(|_| [0; 3].map(|_| DVec2::new(coordinate(SIZE[0]), coordinate(SIZE[1])))).collect();
    let mut bins = bins();
    for (quad, triangle) in (1..).zip(&triangles) {
        bins.add(quad, triangle, FULL);
    }
    let pairs = bins.pairs();
    let lists = lists(&mut bins);
    assert_eq!(lists.iter().map(|(_, list)| list.len()).sum::<usize>(), pairs);
    let mut inside = 0;
    for (quad, [a, b, c]) in (1..).zip(&triangles) {
        for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
            let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let sides = [(a, b), (b, c), (c, a)].map(|(p0, p1)| (*p1 - *p0).perp_dot(p - *p0) > 0.0);
            if sides[0] == sides[1] && sides[1] == sides[2] {
                let (_, list) = lists.iter().find(|(tile, _)| *tile == [x / TILE, y / TILE]).expect("a list");
                assert!(list.contains(&quad), "{quad} at {x} {y}");
                inside += 1;
            }
        }
    }
    assert!(inside > 1000, "{inside}");
}

#[test]
fn thin_polygons_are_listed_along_their_way_only() {
    let mut bins = bins();
    let p = |x: f64, y: f64| DVec2::new(x, y);
    bins.add(1, &[p(0.0, 0.0), p(100.0, 60.0), p(100.0, 60.5), p(0.0, 0.5)], FULL);
    // Slope 5/3: a row of 8 pixels takes 13.3 columns, at most three tiles.
    assert!(bins.pairs() <= 8 * 3, "{}", bins.pairs());
    // Between two rows of pixel centres, and off the image.
    bins.clear(SIZE);
    bins.add(1, &[p(0.0, 8.6), p(100.0, 8.6), p(100.0, 9.4), p(0.0, 9.4)], FULL);
    bins.add(2, &[p(101.0, 0.0), p(120.0, 0.0), p(120.0, 60.0)], FULL);
    bins.add(3, &[], FULL);
    assert_eq!(bins.pairs(), 0);
}

#[test]
fn a_scissor_keeps_whole_tiles() {
    let mut bins = bins();
    let everything = [DVec2::new(-9.0, -9.0), DVec2::new(300.0, -9.0), DVec2::new(-9.0, 300.0)];
    bins.add(1, &everything, [9, 15, 8, 2]);
    bins.add(2, &everything, [0, 0, 0, 5]);
    let mut tiles: Vec<_> = lists(&mut bins).into_iter().map(|(tile, _)| tile).collect();
    tiles.sort_unstable();
    assert_eq!(tiles, [[1, 1], [1, 2], [2, 1], [2, 2]]);
}

#[test]
fn groups_hold_lists_of_like_length() {
    let mut bins = bins();
    let rectangle = |x: f64, y: f64| [DVec2::ZERO, DVec2::new(x, 0.0), DVec2::new(x, y), DVec2::new(0.0, y)];
    for quad in 1..20 {
        let reach = f64::from(quad) * 5.0;
        bins.add(quad, &rectangle(reach, reach), FULL);
    }
    let (mut entries, mut groups, mut places) = (Vec::new(), Vec::new(), Vec::new());
    bins.append(&mut entries, &mut groups, &mut places);
    assert!(groups.len() > 2 && groups.is_sorted_by(|a, b| a.length >= b.length), "{groups:?}");
    assert_eq!(entries.len(), groups.iter().map(|group| group.length as usize * LANES).sum::<usize>());
}
