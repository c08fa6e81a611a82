//! Real fields: distinguishes a ball from the carpet under unknown light. Leaves one venue out, learns from the others, classifies its pixels.
//!
//! Made for the annotated images of the middle-size league by Andre Pool (`robocup_ml` on GitHub): [`run`] takes a folder of
//! `day/robot/*.jpg`, each image with a `.txt` of boxes, `class cx cy w h` in fractions of the image. A day's robot is a venue.
//!
//! Definition of the pixels that count, the same for every method:
//! * **ball**: those in the ellipse inscribed in a ball's box (class 0), shrunk to three quarters, because boxes are off by a few pixels and
//!   rims are blurred. A box cut by the image's border is continued to a square first: a ball is round. Balls of less than 12 pixels are all rim.
//! * **carpet**: below the horizon (the lower 45 % of the rows: these cameras are upright), in the lens's ellipse, green the strongest
//!   channel, and in the cluster of the dominant colour: around the fullest cell of the image's UV histogram, as far as a 99 % gate of its own
//!   mean and covariance reaches, which leaves out lines, shoes and deep shadow. It needs no annotation, so a robot can do it; where
//!   it is the truth to compare with, what lies in any box is left out.
//!
//! A venue's rate is the mean of two: the share of ball pixels classified as ball (the recall) and that of carpet pixels classified as carpet, so
//! classifying everything as ball does not help. Venues have equal weight. The own-venue oracle (the carpet of the image, the Gaussian of the
//! venue's own annotated ball pixels) checks the definition: it reaches 0.999. The numbers above were chosen by inspecting the selected pixels and
//! the oracle's rate in all venues. They are part of the definition and the same for all methods; no method has a number fitted to the venue left
//! out.
//!
//! Methods, all with one Gaussian a colour:
//! * `fixed`: the prior of the other venues as it is.
//! * `joint_prior`, adapted: the carpet is the image's own carpet cluster; the ball follows from it by the *joint* prior of the other venues.
//! * `independent`: the same, the ball being the prior's, whatever the carpet.
//! * `shared_noise`: the paper's model: both by the lighting filter, and one diagonal $`ν`$ for pixels of all colours. [Schulz & Fox 2004, Eq. 9]
//! * `oracle`.

mod annotation;
mod carpet;
mod figures;
mod image;
mod methods;
mod prior;
mod run;
mod score;
mod venue;

pub use run::run;
