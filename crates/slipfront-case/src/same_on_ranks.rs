//! Comparison of inputs that must be the same on all ranks, before the ranks communicate for other reasons.

use blake3::OUT_LEN;
use slipfront::Communicator;
use slipfront::communicator::{lowest_rank, text_of};
use thiserror::Error;

use slipfront_base::text::truncated;

/// A difference between the inputs of a rank and those of rank 0.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "{name} is {found} on rank {rank} and {expected} on rank 0: start all ranks with the same program, options and files"
)]
pub struct Difference {
    /// Name of the input that differs.
    pub name: String,
    /// The lowest rank on which the input differs.
    pub rank: usize,
    /// Value of the input on that rank.
    pub found: String,
    /// Value of the input on rank 0.
    pub expected: String,
}

/// Names of inputs that must be the same on all ranks, each with its value on this rank.
pub type NamedInputs = Vec<(String, String)>;

/// Fails on all ranks, with the same words, unless all have been `given` the same inputs. Every rank must
/// call this.
///
/// ```
/// use slipfront::Communicator;
/// use slipfront::testing::Threads;
/// use slipfront_case::same_on_ranks::expect_same;
///
/// let said = Threads::run(3, |rank| {
///     let speed = if rank.rank() == 2 { "0.2" } else { "0.03" };
///     expect_same(rank, || vec![("v*".to_owned(), speed.to_owned())]).map_err(|error| error.to_string())
/// });
/// let sentence = "v* is 0.2 on rank 2 and 0.03 on rank 0: start all ranks with the same program, options and files";
/// assert_eq!(said, vec![Err(sentence.to_owned()); 3]);
/// ```
///
/// # Errors
/// The first [`Difference`] of the lowest rank that has one.
pub fn expect_same(
    communicator: &dyn Communicator,
    given: impl FnOnce() -> NamedInputs,
) -> Result<(), Difference> {
    if communicator.size() == 1 {
        return Ok(());
    }
    // Serialisation of strings cannot fail.
    let own = serde_json::to_string(&given()).unwrap_or_default();
    // This first message of the ranks has the same length for any inputs, and must keep it: programs of
    // different versions begin with it.
    let hash = words_of(&blake3::hash(own.as_bytes()));
    let mut of_first = hash.map(|word| if communicator.rank() == 0 { word } else { 0 });
    communicator.sum(&mut of_first);
    let Some(rank) = lowest_rank(communicator, hash != of_first) else {
        return Ok(());
    };
    let [expected, found] = [0, rank].map(|rank| read_given(&text_of(communicator, rank, &own)));
    let is_missing = |given: &NamedInputs, name: &str| given.iter().all(|(known, _)| known != name);
    let differs = expected.iter().find(|entry| !found.contains(entry));
    let differs = differs.or_else(|| found.iter().find(|(name, _)| is_missing(&expected, name)));
    let name = differs.map_or("the order of what it was given", |(name, _)| name);
    let value = |given: &NamedInputs| {
        let entry = given.iter().find(|(known, _)| known == name);
        entry.map_or("not given".to_owned(), |(_, value)| truncated(value))
    };
    Err(Difference {
        rank,
        found: value(&found),
        expected: value(&expected),
        name: name.to_owned(),
    })
}

/// Inputs of a rank, from their text; the text itself if another version has written it in another form.
fn read_given(text: &str) -> NamedInputs {
    serde_json::from_str(text).unwrap_or_else(|_| vec![("what it was given".to_owned(), text.to_owned())])
}

/// A hash as integers, which ranks can exchange.
pub(crate) fn words_of(hash: &blake3::Hash) -> [i64; OUT_LEN / size_of::<i64>()] {
    let mut words = [0; OUT_LEN / size_of::<i64>()];
    for (word, bytes) in words.iter_mut().zip(hash.as_bytes().as_chunks().0) {
        *word = i64::from_le_bytes(*bytes);
    }
    words
}

/// The words of all ranks, rank 0 first.
pub fn of_all(communicator: &dyn Communicator, word: i64) -> Vec<i64> {
    let mut words = vec![0; communicator.size()];
    words[communicator.rank()] = word;
    communicator.sum(&mut words);
    words
}
