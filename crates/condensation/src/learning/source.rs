use image::RgbImage;

use crate::features::shifted;
use crate::{
    CondensationError, DiscreteStateSpace, GlobalDescriptor, LightChange, StateDescriptorTable, View,
    ViewGrid,
};

/// Where learned views come from, and how they would look shifted and in another light.
pub trait ViewSource {
    /// How many states there are.
    fn n_states(&self) -> usize;

    /// The features of every state, with the views shifted by whole pixels, in a light.
    ///
    /// # Errors
    /// When the light is not valid.
    fn features(
        &self,
        feature: &dyn GlobalDescriptor,
        shift: (i32, i32),
        light: &LightChange,
    ) -> Result<StateDescriptorTable, CondensationError>;

    /// The actual shift of the view of `state` for a requested `shift`: smaller at the border of the scene.
    fn displacement(&self, state: usize, shift: (i32, i32)) -> (f64, f64);

    /// Half the distance between neighbouring states in pixels, if they are shifted against each other: a view shifted by more belongs to
    /// the neighbour. By default they are not.
    fn half_spacing(&self) -> f64 {
        f64::INFINITY
    }
}

/// Views of one large scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneViews<'a> {
    scene: &'a RgbImage,
    views: &'a ViewGrid,
}

impl<'a> SceneViews<'a> {
    /// The views of a scene.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the scene is not of the size that the views were laid out for.
    pub fn new(scene: &'a RgbImage, views: &'a ViewGrid) -> Result<Self, CondensationError> {
        views.check(scene)?;
        Ok(Self { scene, views })
    }
}

impl ViewSource for SceneViews<'_> {
    fn n_states(&self) -> usize {
        self.views.grid().n_states()
    }

    fn features(
        &self,
        feature: &dyn GlobalDescriptor,
        (dx, dy): (i32, i32),
        light: &LightChange,
    ) -> Result<StateDescriptorTable, CondensationError> {
        let views = self.views.moved(dx, dy);
        if *light == LightChange::SAME {
            return feature.extract_all(self.scene, &views);
        }
        feature.extract_all(&light.apply(self.scene)?, &views)
    }

    fn displacement(&self, state: usize, (dx, dy): (i32, i32)) -> (f64, f64) {
        let moved = self.views.moved(dx, dy);
        match (self.views.corner(state), moved.corner(state)) {
            (Ok(from), Ok(to)) => (to.0 as f64 - from.0 as f64, to.1 as f64 - from.1 as f64),
            _ => (0.0, 0.0),
        }
    }

    fn half_spacing(&self) -> f64 {
        0.5 * self.views.step() as f64
    }
}

/// One picture a state: places along a route, say.
#[derive(Clone, Copy, Debug)]
pub struct OneViewPerPicture<'a> {
    pictures: &'a [RgbImage],
}

impl<'a> OneViewPerPicture<'a> {
    /// One picture a state; they need not be of one size.
    ///
    /// # Errors
    /// [`CondensationError::Empty`] without pictures, [`CondensationError::Extent`] when one has no pixels.
    pub fn new(pictures: &'a [RgbImage]) -> Result<Self, CondensationError> {
        if pictures.is_empty() {
            return Err(CondensationError::Empty { what: "pictures" });
        }
        pictures.iter().try_for_each(|picture| View::whole(picture).map(|_| ()))?;
        Ok(Self { pictures })
    }
}

impl ViewSource for OneViewPerPicture<'_> {
    fn n_states(&self) -> usize {
        self.pictures.len()
    }

    fn features(
        &self,
        feature: &dyn GlobalDescriptor,
        (dx, dy): (i32, i32),
        light: &LightChange,
    ) -> Result<StateDescriptorTable, CondensationError> {
        let mut rows = Vec::with_capacity(self.pictures.len());
        for picture in self.pictures {
            let mut row = vec![0.0; feature.n_components()];
            feature.extract(&View::whole(&shifted(&light.apply(picture)?, dx, dy))?, &mut row);
            rows.push(row);
        }
        StateDescriptorTable::from_rows(&rows)
    }

    fn displacement(&self, _: usize, (dx, dy): (i32, i32)) -> (f64, f64) {
        (f64::from(dx), f64::from(dy))
    }
}
