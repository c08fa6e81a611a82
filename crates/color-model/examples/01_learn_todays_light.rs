//! Two colours under a light that nobody has measured: one is seen, the other follows.
//!
//! `cargo run -p wayfix-color-model --example 01_learn_todays_light`

use nalgebra::{DMatrix, DVector, Vector3};
use wayfix_color_map::ColorId;
use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterBank, LightingFilterParams};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::MarkovChain;

/// What orange and blue look like in YUV under one kind of light; they become brighter and darker together.
fn kind_of_light(brightness: f64) -> Result<LightingFilter, Box<dyn std::error::Error>> {
    let mean = DVector::from_vec(vec![1.1 * brightness, 90.0, 200.0, 0.6 * brightness, 170.0, 110.0]);
    let mut covariance = DMatrix::from_diagonal_element(6, 6, 400.0);
    (covariance[(0, 3)], covariance[(3, 0)]) = (360.0, 360.0);
    Ok(LightingFilter::new(Gaussian::new(mean, covariance)?, LightingFilterParams::default())?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1. It may be dark or bright; lights are switched once in fifty images or so.
    let mut bank = LightingFilterBank::new(
        vec![kind_of_light(70.0)?, kind_of_light(150.0)?],
        MarkovChain::sticky(2, 0.98)?,
    )?;

    // 2. An image shows 800 orange pixels and nothing blue. Which light is it?
    let seen = ColorMeans::new([(Some(Vector3::new(190.0, 88.0, 205.0)), 800), (None, 0)]);
    let fit = [0, 1].map(|member| bank.clone().update_member(member, &seen));
    let [dark, bright] = [fit[0].clone()?, fit[1].clone()?];
    println!("log likelihood: dark {dark:.1}, bright {bright:.1} nats");
    assert!(bright > dark + 10.0);

    // 3. The bright filter learns, the dark one keeps what it knew.
    bank.predict(0.04)?;
    bank.update_member(1, &seen)?;
    let blue = bank.member(1).color(ColorId(1));
    println!("blue, never seen: Y = {:.0} ± {:.0}", blue.mean.x, blue.covariance.m11.sqrt());
    assert!(blue.mean.x > 105.0); // the prior said 90; orange is brighter than expected, so blue is too
    assert_eq!(bank.member(0).mean()[0], 77.0);
    Ok(())
}
