// @ts-check
// What the address asks for behind its #, such as `case=gear`, `lesson=3` or `field=first_slip`.

/** The value of a part of the address, or null if it has none. @param {string} name */
export const inAddress = (name) => new URLSearchParams(location.hash.slice(1)).get(name);
