//! Numbers and times of a table.

/// A number with this decimal sign, a point or a comma; it may be infinite or no number (`nan`).
///
/// ```
/// use slipfront_case::table::number;
///
/// assert_eq!(number("0,25", ','), Some(0.25));
/// assert_eq!(number("0,25", '.'), None);
/// // With decimal commas a point is a thousands separator, and so is a comma with decimal points.
/// assert_eq!(number("1.050,5", ','), None);
/// ```
pub fn number(field: &str, decimal: char) -> Option<f64> {
    if decimal == '.' {
        return field.parse().ok();
    }
    match field.split_once(',') {
        None => field.parse().ok().filter(|_| !field.contains('.')),
        // A separator of columns may stand behind a number without decimals.
        Some((_, "")) => None,
        Some((whole, decimals)) if !whole.contains('.') => format!("{whole}.{decimals}").parse().ok(),
        Some(_) => None,
    }
}

/// Seconds from midnight of a time of the day, such as `10:04:31` or `10:04:31,250`.
///
/// ```
/// use slipfront_case::table::clock_time;
///
/// assert_eq!(clock_time("00:01:02.5"), Some(62.5));
/// assert_eq!(clock_time("1:2"), None);
/// ```
pub fn clock_time(field: &str) -> Option<f64> {
    let mut parts = field.split(':');
    let (hours, minutes, seconds) = (parts.next()?, parts.next()?, parts.next()?);
    let whole = |text: &str, most: u32| {
        text.parse::<u32>()
            .ok()
            .filter(|number| *number <= most)
            .map(f64::from)
    };
    let seconds = number(&seconds.replace(',', "."), '.').filter(|seconds| (0.0..60.0).contains(seconds))?;
    parts
        .next()
        .is_none()
        .then_some(3600.0 * whole(hours, u32::MAX)? + 60.0 * whole(minutes, 59)? + seconds)
}

/// Whether a field can be a number with a thousands separator: groups of three digits behind one to three, of
/// which the first is not 0.
pub(super) fn has_groups(field: &str, separator: char) -> bool {
    let field = field.trim_start_matches(['+', '-']);
    let mut groups = field.split(separator);
    let first = groups.next().unwrap_or_default();
    let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let mut n = 0;
    (1..=3).contains(&first.len())
        && is_digits(first)
        && !first.starts_with('0')
        && groups.all(|group| {
            n += 1;
            group.len() == 3 && is_digits(group)
        })
        && n > 0
}
