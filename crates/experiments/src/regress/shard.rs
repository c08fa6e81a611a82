use std::{fmt, str::FromStr};

/// A share of the work: the `number`-th of `total`, from 1.
///
/// ```
/// use wayfix_experiments::regress::CampaignShard;
/// let third: CampaignShard = "3/4".parse()?;
/// assert_eq!((0..9).filter(|index| third.takes(*index)).collect::<Vec<_>>(), [2, 6]);
/// assert!("5/4".parse::<CampaignShard>().is_err() && "0/4".parse::<CampaignShard>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CampaignShard {
    number: usize,
    total: usize,
}

impl CampaignShard {
    /// All of the work.
    pub const WHOLE: Self = Self { number: 1, total: 1 };

    /// Whether this shard does the work with this index. Neighbours, which cost about the same, go to different shards.
    pub fn takes(self, index: usize) -> bool {
        index % self.total == self.number - 1
    }

    /// The pieces of `work` that this shard does.
    pub fn share<T>(self, work: Vec<T>) -> Vec<T> {
        let mine = work.into_iter().enumerate().filter(|(index, _)| self.takes(*index));
        mine.map(|(_, piece)| piece).collect()
    }

    /// Whether there are others.
    pub fn is_part(self) -> bool {
        self.total > 1
    }

    /// Number of shards.
    pub fn total(self) -> usize {
        self.total
    }
}

impl FromStr for CampaignShard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((number, total)) if 1 <= number && number <= total => Ok(Self { number, total }),
            _ => Err("give K/N with 1 ≤ K ≤ N, for instance 3/8 for the third of eight jobs".to_owned()),
        }
    }
}

impl fmt::Display for CampaignShard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.total)
    }
}
