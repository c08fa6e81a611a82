/// Errors of building a map. `shape` is the index of the invalid shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorMapError {
    /// More colours than a label image can represent.
    #[error("{got} colours, at most {limit} are possible")]
    TooManyColors {
        /// The largest number possible.
        limit: usize,
        /// The number given.
        got: usize,
    },
    /// Two colours have one name.
    #[error("two colours are called {name:?}")]
    DuplicateColor {
        /// The name.
        name: String,
    },
    /// A shape has a colour that the map does not have.
    #[error("shape {shape} has colour {color}, but there are {n_colors} colours")]
    UnknownColor {
        /// Which shape.
        shape: usize,
        /// Its colour.
        color: u8,
        /// Number of colours of the map.
        n_colors: usize,
    },
    /// A map file names a colour that it does not list.
    #[error("no colour is called {name:?}")]
    UnknownColorName {
        /// The name.
        name: String,
    },
    /// A length or coordinate is out of range.
    #[error("shape {shape}: {what} is {value}, must be {must}")]
    Value {
        /// Which shape.
        shape: usize,
        /// Which of its numbers, with its unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// A polygon of fewer than three corners.
    #[error("polygon {shape} has {got} vertices, at least 3 are needed")]
    TooFewVertices {
        /// Which shape.
        shape: usize,
        /// Its corners.
        got: usize,
    },
    /// A polygon without width.
    #[error("polygon {shape} is degenerate: {area_m2:e} m² within {perimeter_m} m")]
    Degenerate {
        /// Which shape.
        shape: usize,
        /// Its area.
        area_m2: f64,
        /// Length of the perimeter.
        perimeter_m: f64,
    },
    /// A corner that does not lie on the plane of its polygon.
    #[error("polygon {shape} is not flat: vertex {vertex} is {distance_m:e} m off its plane")]
    NotPlanar {
        /// Which shape.
        shape: usize,
        /// Which corner.
        vertex: usize,
        /// Its distance from the plane.
        distance_m: f64,
    },
    /// A polygon with a corner on the outer side of one of its own edges.
    #[error("polygon {shape} is not convex: vertex {vertex} is {distance_m:e} m outside one of its edges")]
    NotConvex {
        /// Which shape.
        shape: usize,
        /// Which corner.
        vertex: usize,
        /// Its distance outside.
        distance_m: f64,
    },
    /// A post without bands.
    #[error("post {shape} has no bands")]
    NoBands {
        /// Which shape.
        shape: usize,
    },
    /// A band of a post that is empty or begins below the end of the one before it.
    #[error(
        "post {shape}: band {band} from {from_m} m to {to_m} m, but it must go up and begin at {least_m} m or above"
    )]
    BandOrder {
        /// Which shape.
        shape: usize,
        /// Which band.
        band: usize,
        /// Lower end of the band.
        from_m: f64,
        /// Upper end of the band.
        to_m: f64,
        /// Upper end of the band below.
        least_m: f64,
    },
    /// Two posts that intersect, seen from above.
    #[error("posts {first} and {second} are {distance_m} m apart, at least {least_m} m is needed")]
    PostsOverlap {
        /// The earlier one.
        first: usize,
        /// The later one.
        second: usize,
        /// Between their centres.
        distance_m: f64,
        /// The minimum distance of disjoint posts.
        least_m: f64,
    },
    /// The surfaces cut each other into more pieces than a view can be sorted from.
    #[error("the surfaces cut each other into more than {limit} pieces")]
    TooManyPieces {
        /// The largest number possible.
        limit: usize,
    },
}

/// Errors of rendering a view. No span was emitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A parameter of the camera is out of range.
    #[error("camera: {what} is {value}, must be {must}")]
    Camera {
        /// Which number, with its unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// A number of the camera pose is out of range.
    #[error("camera pose: {what} is {value}, must be {must}")]
    Pose {
        /// Which number, with its unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// Labels and image differ in size.
    #[error("a label image of {width}x{height} has {expected} pixels, got {got}")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Their product.
        expected: usize,
        /// The number of labels that came.
        got: usize,
    },
}
