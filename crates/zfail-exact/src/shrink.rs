//! The least recipe that still fails.

use crate::recipe::Recipe;

/// Leaves out lights and parts, one at a time and as long as `fails` holds.
pub fn shrink(mut recipe: Recipe, mut fails: impl FnMut(&Recipe) -> bool) -> Recipe {
    loop {
        let lights = (0..recipe.lights.len()).filter(|_| recipe.lights.len() > 1).map(|i| {
            let mut less = recipe.clone();
            less.lights.remove(i);
            less
        });
        let parts = (0..recipe.parts.len()).map(|i| {
            let mut less = recipe.clone();
            less.parts.remove(i);
            less
        });
        let Some(less) = lights.chain(parts).find(&mut fails) else { return recipe };
        recipe = less;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::Kind;
    use crate::shapes::Shape;

    #[test]
    fn keeps_what_is_needed_and_nothing_else() {
        let recipe = (0..).map(|seed| Kind::Closed.recipe(seed, [8, 8])).find(|r| r.parts.len() == 5).unwrap();
        let wanted: [Shape; 2] = [recipe.parts[1].shape, recipe.parts[4].shape];
        let light = recipe.lights[1];
        let fails =
            |r: &Recipe| wanted.iter().all(|s| r.parts.iter().any(|p| p.shape == *s)) && r.lights.contains(&light);
        let least = shrink(recipe, fails);
        assert!(least.parts.len() <= 2 && least.lights == [light], "{least:?}");
        assert!(fails(&least));
    }
}
