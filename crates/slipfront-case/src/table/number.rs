//! Numbers and times of a table.

/// Reads a number with this decimal sign, a point or a comma; it may be infinite or NaN (`nan`).
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
        // A trailing comma is not a decimal sign: it may separate columns.
        Some((_, "")) => None,
        Some((whole, decimals)) if !whole.contains('.') => format!("{whole}.{decimals}").parse().ok(),
        Some(_) => None,
    }
}

/// Time of day in seconds.
///
/// - From midnight: `10:04:31`, `10:04:31,250` or `1:04:31 PM`; of Greenwich with a zone, `10:04:31+01:00`.
/// - From the full hour: `04:31.250`, with decimals, since `04:31` may be hours and minutes.
/// - From the first midnight of 2000, after a date: `2024-01-31T10:04:31` or `31.01.2024 10:04:31`.
/// - From midnight too, after a date with slashes and the year last: it does not show which number is the
///   month.
///
/// ```
/// use slipfront_case::table::clock_time;
///
/// assert_eq!(clock_time("00:01:02.5"), Some(62.5));
/// assert_eq!(clock_time("2000-03-01 00:00:01"), Some(60.0 * 86_400.0 + 1.0));
/// assert_eq!(clock_time("1:2"), None);
/// ```
pub fn clock_time(field: &str) -> Option<f64> {
    // Most fields are not times, and are rejected here at little cost.
    field.find(':')?;
    let field = field.replace(['\u{a0}', '\u{202f}'], " ");
    let field = field.as_str();
    let is_half = |half: &&str| ["AM", "PM"].iter().any(|known| half.eq_ignore_ascii_case(known));
    let (rest, half) = match field.rsplit_once(' ').filter(|(_, half)| is_half(half)) {
        Some((rest, half)) => (rest, Some(half)),
        None => (field, None),
    };
    let (date, clock) = match rest.split_once([' ', 'T']) {
        Some((date, clock)) => (day(date)?, clock.trim()),
        None => (0, rest),
    };
    let (clock, ahead) = without_zone(clock)?;
    let parts: Vec<&str> = clock.split(':').collect();
    let (hours, minutes, seconds) = match parts[..] {
        [hours, minutes, seconds] => (hours, minutes, seconds),
        [minutes, seconds] if seconds.contains(['.', ',']) => ("0", minutes, seconds),
        _ => return None,
    };
    let whole = |text: &str, most: u32| text.parse::<u32>().ok().filter(|number| *number <= most);
    let hours = match half {
        Some(half) => whole(hours, 12)? % 12 + 12 * u32::from(half.eq_ignore_ascii_case("PM")),
        None => whole(hours, u32::MAX)?,
    };
    let seconds = number(&seconds.replace(',', "."), '.').filter(|seconds| (0.0..60.0).contains(seconds))?;
    let whole = 86_400.0 * date as f64 + 3600.0 * f64::from(hours) + 60.0 * f64::from(whole(minutes, 59)?);
    Some(whole + seconds - ahead)
}

/// A clock without its zone, and the seconds by which the zone is ahead of Greenwich: `Z`, `+01`, `+0100` or
/// `+01:00`.
fn without_zone(clock: &str) -> Option<(&str, f64)> {
    if let Some(clock) = clock.strip_suffix('Z') {
        return Some((clock, 0.0));
    }
    let Some(at) = clock.rfind(['+', '-']) else {
        return Some((clock, 0.0));
    };
    let (clock, zone) = clock.split_at(at);
    let (sign, digits) = zone.split_at(1);
    let digits = digits.replacen(':', "", 1);
    if !matches!(digits.len(), 2 | 4) || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let (hours, minutes) = digits.split_at(2);
    let minutes = if minutes.is_empty() { "0" } else { minutes };
    let [hours, minutes]: [u32; 2] = [hours.parse().ok()?, minutes.parse().ok()?];
    let ahead = f64::from(3600 * hours + 60 * minutes);
    (hours <= 14 && minutes < 60).then_some((clock, if sign == "-" { -ahead } else { ahead }))
}

/// Days from 2000-01-01 to a date in the Gregorian calendar.
fn day(date: &str) -> Option<i64> {
    let mut parts = date.split(['-', '/', '.']).map(|part| part.parse::<i64>().ok());
    let numbers = [parts.next()??, parts.next()??, parts.next()??];
    let [year, month, day] = match numbers {
        [year, ..] if year > 31 => numbers,
        [day, month, year] if date.contains('.') => [year, month, day],
        _ => return Some(0),
    };
    let is_date = (1..=12).contains(&month) && (1..=31).contains(&day) && (0..=9999).contains(&year);
    if !is_date || parts.next().is_some() {
        return None;
    }
    // Day of the Julian count: years begin in March, so that the leap day is last.
    let early = (14 - month) / 12;
    let (year, month) = (year + 4800 - early, month + 12 * early - 3);
    Some(day + (153 * month + 2) / 5 + 365 * year + year / 4 - year / 100 + year / 400 - 32_045 - 2_451_545)
}

/// Whether a field is a number with thousands separators in addition to its decimal sign, such as `1,000.5`.
///
/// ```
/// use slipfront_case::table::has_thousands;
///
/// assert!(has_thousands("1,000.12", '.') && has_thousands("-12.345,6", ',') && has_thousands("1,000,292", ','));
/// assert!(!has_thousands("1000.12", '.') && !has_thousands("2024-01-01", '.'));
/// ```
pub fn has_thousands(field: &str, decimal: char) -> bool {
    let (whole, decimals) = field.split_once(decimal).unwrap_or((field, ""));
    let is_other = |separator: char| separator != decimal && has_groups(whole, separator);
    [',', '.', '\'', ' ', '\u{a0}', '\u{202f}']
        .into_iter()
        .any(is_other)
        || (decimals.contains(decimal) && has_groups(field, decimal))
}

/// Whether a field can be a number with a thousands separator: one to three digits that do not begin with 0,
/// followed by groups of three digits.
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

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::clock_time;

    #[test_case("12:00:00 AM", Some(0.0); "midnight")]
    #[test_case("12:00:01 pm", Some(43_201.0); "noon")]
    #[test_case("13:00:00 PM", None; "no hour of a half day")]
    #[test_case("2000-01-01T00:00:00", Some(0.0); "first")]
    #[test_case("2000/02/29 00:00:00", Some(59.0 * 86_400.0); "leap day")]
    #[test_case("1.3.2001 0:00:02,5", Some(425.0 * 86_400.0 + 2.5); "day first")]
    #[test_case("1/2/2024 00:00:03", Some(3.0); "month not known")]
    #[test_case("2024-13-01 00:00:00", None; "no month")]
    #[test_case("Probe 00:00:00", None; "no date")]
    #[test_case("2000-01-01T01:00:02.5+01:00", Some(2.5); "zone")]
    #[test_case("2000-01-01T00:00:02Z", Some(2.0); "Greenwich")]
    #[test_case("1999-12-31 19:00:02-0500", Some(2.0); "behind")]
    #[test_case("00:00:02+24:00", None; "no zone")]
    #[test_case("00:00:02+1", None; "half a zone")]
    #[test_case("2000-01-01\u{a0}00:00:03", Some(3.0); "no-break space")]
    #[test_case("12:00:01\u{202f}AM", Some(1.0); "narrow no-break space")]
    #[test_case("04:31.250", Some(271.25); "minutes and seconds")]
    #[test_case("04:31,2", Some(271.2); "minutes and seconds with a comma")]
    #[test_case("04:31", None; "hours or minutes")]
    #[test_case("04:61.0", None; "no seconds")]
    fn times_of_the_day(field: &str, seconds: Option<f64>) {
        assert_eq!(clock_time(field), seconds);
    }
}
