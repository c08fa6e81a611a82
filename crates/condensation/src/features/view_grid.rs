use image::RgbImage;

use crate::{CondensationError, PositionGrid, View};

/// The views of a scene: a window that moves in steps of so many pixels, one state a position. [Kasprzak & Szynkiewicz, Sec. 2.3, Fig. 2]
///
/// ```
/// use wayfix_condensation::{DiscreteStateSpace, ViewGrid};
/// let views = ViewGrid::new((640, 427), (128, 128), 32)?;
/// assert_eq!((views.grid().columns(), views.grid().rows()), (17, 10));
/// assert_eq!(views.corner(18)?, (32, 32));
/// assert!(ViewGrid::new((100, 100), (128, 128), 32).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewGrid {
    scene: (usize, usize),
    view: (usize, usize),
    step: usize,
    grid: PositionGrid,
    lefts: Vec<usize>,
    tops: Vec<usize>,
}

impl ViewGrid {
    /// Views of `view` pixels in a scene of `scene`, both width and height, with `step` pixels between neighbours.
    ///
    /// # Errors
    /// [`CondensationError::SceneSmallerThanView`], [`CondensationError::Extent`] when the view or the step is zero.
    pub fn new(scene: (usize, usize), view: (usize, usize), step: usize) -> Result<Self, CondensationError> {
        if view.0 == 0 || view.1 == 0 || step == 0 {
            return Err(CondensationError::Extent {
                what: "view and step",
                size: vec![view.0, view.1, step],
            });
        }
        if view.0 > scene.0 || view.1 > scene.1 {
            return Err(CondensationError::SceneSmallerThanView { scene, view });
        }
        let positions = |scene: usize, view: usize| (0..=scene - view).step_by(step).collect::<Vec<_>>();
        let (lefts, tops) = (positions(scene.0, view.0), positions(scene.1, view.1));
        Ok(Self { scene, view, step, grid: PositionGrid::new(lefts.len(), tops.len())?, lefts, tops })
    }

    /// The states.
    pub fn grid(&self) -> &PositionGrid {
        &self.grid
    }

    /// Width and height of a view, in pixels.
    pub fn view_size(&self) -> (usize, usize) {
        self.view
    }

    /// Pixels between neighbouring views.
    pub fn step(&self) -> usize {
        self.step
    }

    /// Width and height of the scene, in pixels.
    pub(crate) fn scene_size(&self) -> (usize, usize) {
        self.scene
    }

    /// Where the view of a state starts: left and top pixel.
    ///
    /// # Errors
    /// [`CondensationError::State`] when there is no such state.
    pub fn corner(&self, state: usize) -> Result<(usize, usize), CondensationError> {
        crate::error::check_state(state, self.lefts.len() * self.tops.len())?;
        let (column, row) = self.grid.place(state);
        Ok((self.lefts[column], self.tops[row]))
    }

    /// What is seen in a state.
    ///
    /// # Errors
    /// [`CondensationError::State`], or [`CondensationError::Dimension`] when the scene is of another size.
    pub fn view<'a>(&self, scene: &'a RgbImage, state: usize) -> Result<View<'a>, CondensationError> {
        self.check(scene)?;
        Ok(View::inside(scene, self.corner(state)?, self.view))
    }

    /// The same states with every view moved by so many pixels, as far as the scene reaches.
    pub fn moved(&self, dx: i32, dy: i32) -> Self {
        let moved = |starts: &[usize], by: i32, last: usize| {
            starts.iter().map(|start| start.saturating_add_signed(by as isize).min(last)).collect()
        };
        Self {
            lefts: moved(&self.lefts, dx, self.scene.0 - self.view.0),
            tops: moved(&self.tops, dy, self.scene.1 - self.view.1),
            ..self.clone()
        }
    }

    /// First columns of the views, by column of the grid.
    pub(crate) fn lefts(&self) -> &[usize] {
        &self.lefts
    }

    /// First rows of the views, by row of the grid.
    pub(crate) fn tops(&self) -> &[usize] {
        &self.tops
    }

    /// Whether a scene has the size these views were laid out for.
    pub(crate) fn check(&self, scene: &RgbImage) -> Result<(), CondensationError> {
        let (width, height) = crate::features::picture::size(scene);
        crate::error::check_size("width of the scene", self.scene.0, width)?;
        crate::error::check_size("height of the scene", self.scene.1, height)
    }
}
