//! Mutations that keep JSON valid, so that what comes after parsing is reached.
//!
//! In: the bytes of a `scene` input. Out: the same with a few values of its JSON changed, or with some bytes changed as
//! libFuzzer does it.

use crate::loading::unpack;
use fastrand::Rng;
use serde_json::{Value, json};

/// Numbers at which loaders err: around limits of types, counts and component types.
const NUMBERS: [f64; 24] = [
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    5.0,
    6.0,
    12.0,
    16.0,
    -1.0,
    0.5,
    127.0,
    255.0,
    256.0,
    65535.0,
    65536.0,
    5121.0,
    5123.0,
    5125.0,
    5126.0,
    2147483648.0,
    4294967295.0,
    9007199254740993.0,
    1e300,
];

/// Words of glTF that choose among branches.
const WORDS: [&str; 28] = [
    "SCALAR",
    "VEC2",
    "VEC3",
    "VEC4",
    "MAT4",
    "OPAQUE",
    "MASK",
    "BLEND",
    "LINEAR",
    "STEP",
    "CUBICSPLINE",
    "translation",
    "rotation",
    "scale",
    "weights",
    "point",
    "spot",
    "directional",
    "perspective",
    "orthographic",
    "image/png",
    "image/jpeg",
    "image/webp",
    "image/ktx2",
    "",
    "../x",
    "data:;base64,AA==",
    "\u{0}",
];

/// Changes `data[..size]`; returns the new size.
pub fn scene(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> usize {
    let mut rng = Rng::with_seed(seed.into());
    let structured = unpack(&data[..size]).filter(|_| rng.u8(..) < 160);
    let Some((mut json, binary)) = structured else {
        return libfuzzer_sys::fuzzer_mutate(data, size, max_size);
    };
    for _ in 0..rng.u32(1..4) {
        let donor = nth(&mut json.clone(), rng.usize(..10_000)).clone();
        change(nth(&mut json, rng.usize(..10_000)), donor, &mut rng);
    }
    let bytes = [json.to_string().as_bytes(), &[0], binary].concat();
    if bytes.len() > max_size {
        return libfuzzer_sys::fuzzer_mutate(data, size, max_size);
    }
    data[..bytes.len()].copy_from_slice(&bytes);
    bytes.len()
}

/// Value number `n`, modulo how many there are, in depth-first order.
fn nth(json: &mut Value, n: usize) -> &mut Value {
    let n = n % count(json);
    find(json, n)
}

fn count(json: &Value) -> usize {
    1 + match json {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(members) => members.values().map(count).sum(),
        _ => 0,
    }
}

fn find(json: &mut Value, n: usize) -> &mut Value {
    if n == 0 {
        return json;
    }
    let mut n = n - 1;
    let children: Vec<&mut Value> = match json {
        Value::Array(list) => list.iter_mut().collect(),
        Value::Object(members) => members.values_mut().collect(),
        _ => Vec::new(),
    };
    for child in children {
        let size = count(child);
        if n < size {
            return find(child, n);
        }
        n -= size;
    }
    unreachable!("{n} is less than the number of values")
}

/// Makes something else of `value`; `donor` is a value from elsewhere in the document.
fn change(value: &mut Value, donor: Value, rng: &mut Rng) {
    let other = |rng: &mut Rng| NUMBERS[rng.usize(..NUMBERS.len())];
    match value {
        _ if rng.u8(..) < 24 => *value = donor,
        Value::Number(number) => {
            let old = number.as_f64().unwrap_or_default();
            let new = match rng.u8(..4) {
                0 => old + 1.0,
                1 => old - 1.0,
                2 => rng.u8(..).into(),
                _ => other(rng),
            };
            *value = if new.fract() == 0.0 && new.abs() < 1e15 { json!(new as i64) } else { json!(new) };
        }
        Value::String(text) => WORDS[rng.usize(..WORDS.len())].clone_into(text),
        Value::Bool(truth) => *truth = !*truth,
        Value::Null => *value = json!(other(rng)),
        Value::Array(list) => match (rng.u8(..4), list.len()) {
            (0, 1..) => drop(list.remove(rng.usize(..list.len()))),
            (1, 1..) => list.push(list[rng.usize(..list.len())].clone()),
            (2, 2..) => {
                let (a, b) = (rng.usize(..list.len()), rng.usize(..list.len()));
                list.swap(a, b);
            }
            _ => list.push(donor),
        },
        Value::Object(members) => {
            let Some(key) = members.keys().nth(rng.usize(..members.len().max(1))).cloned() else { return };
            if rng.bool() {
                members.remove(&key);
            } else {
                members.insert(key, donor);
            }
        }
    }
}
