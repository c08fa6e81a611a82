use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use wayfix_condensation::{
    ColorMeanStdDescriptor, ConcatenatedDescriptor, DominantGrayCriterion, DominantGraysDescriptor,
    Fft6Descriptor, GlobalDescriptor, IntensityRegionsDescriptor,
};

/// Feature measured in a view. [Kasprzak & Szynkiewicz, Sec. 3]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DescriptorKind {
    /// Mean and standard deviation of red, green and blue.
    MeanVar,
    /// Moduli of the first six Fourier components along the rows.
    Fft6,
    /// The three dominant grey values and their shares.
    Hist6,
    /// The grey values and shares of `hist6`, and where they are: mass centre and box of each.
    Regions,
    /// All eighteen numbers of the three features.
    Joined,
}

impl DescriptorKind {
    /// The three features of the paper.
    pub const OF_THE_PAPER: [Self; 3] = [Self::MeanVar, Self::Fft6, Self::Hist6];
    /// These three, the regions of the dominant grey values, and the three concatenated.
    pub const ALL: [Self; 5] = [Self::MeanVar, Self::Fft6, Self::Hist6, Self::Regions, Self::Joined];

    /// Its name in figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::MeanVar => "mean_std",
            Self::Fft6 => "fourier6",
            Self::Hist6 => "dominant_grays",
            Self::Regions => "intensity_regions",
            Self::Joined => "joined",
        }
    }

    /// Its name in the paper.
    pub fn title(self) -> &'static str {
        match self {
            Self::MeanVar => "MeanVar",
            Self::Fft6 => "FFT6",
            Self::Hist6 => "Hist6",
            Self::Regions => "Hist6 with positions",
            Self::Joined => "all three joined",
        }
    }

    /// The feature; `dominance` defines the numbers of the histogram.
    pub fn feature(self, dominance: DominantGrayCriterion) -> Box<dyn GlobalDescriptor + Send> {
        match self {
            Self::MeanVar => Box::new(ColorMeanStdDescriptor),
            Self::Fft6 => Box::new(Fft6Descriptor),
            Self::Hist6 => Box::new(DominantGraysDescriptor { dominance }),
            Self::Regions => Box::new(IntensityRegionsDescriptor { dominance }),
            Self::Joined => Box::new(ConcatenatedDescriptor::new(
                Self::OF_THE_PAPER.into_iter().map(|part| part.feature(dominance)).collect(),
            )),
        }
    }
}
