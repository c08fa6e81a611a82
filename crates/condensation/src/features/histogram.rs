//! Histograms of grey values, of one view and sliding along a row of views.

use image::RgbImage;

use crate::features::picture::grey;
use crate::{View, ViewGrid};

/// Pixels of every grey value.
pub(crate) type Histogram = [u32; 256];

/// The histogram of one view.
pub(super) fn of_view(view: &View<'_>) -> Histogram {
    let mut histogram = [0; 256];
    for &grey in view.grey().as_raw() {
        histogram[usize::from(grey)] += 1;
    }
    histogram
}

/// Calls `job(state, histogram)` for every view; from one to the next in a row only the columns that differ are counted.
pub(super) fn for_each_view(scene: &RgbImage, views: &ViewGrid, mut job: impl FnMut(usize, &Histogram)) {
    let ((view_width, view_height), (width, _)) = (views.view_size(), views.scene_size());
    let grey = grey(scene);
    for (row, &top) in views.tops().iter().enumerate() {
        let band = &grey.as_raw()[top * width..][..view_height * width];
        let mut histogram = [0_u32; 256];
        let mut covered = 0..0;
        for (column, &left) in views.lefts().iter().enumerate() {
            let wanted = left..left + view_width;
            for line in band.chunks_exact(width) {
                line[covered.end..wanted.end].iter().for_each(|&grey| histogram[usize::from(grey)] += 1);
                line[covered.start..wanted.start].iter().for_each(|&grey| histogram[usize::from(grey)] -= 1);
            }
            covered = wanted;
            job(row * views.lefts().len() + column, &histogram);
        }
    }
}
