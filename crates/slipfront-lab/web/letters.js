// @ts-check
// Where letters beside vertical lines stand.

/** The row of each letter, 0 for the upper one: a letter that has less than its room behind the one before stands below it. @param {number[]} places from left to right @param {number} room */
export function rowsOf(places, room) {
  let row = 0;
  return places.map((place, k) => {
    row = k > 0 && place - places[k - 1] < room ? row + 1 : 0;
    return row;
  });
}
