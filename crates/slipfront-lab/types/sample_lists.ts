// Types of the lists of messages in `samples.ts`.

/** One or more of a kind, each of which keeps its type. */
export type Some<T> = [T, ...T[]];

/** Samples of messages by their names, which stand under the key `Tag`. */
export type Samples<Messages, Tag extends string> = {
  [Name in keyof Messages]: Some<{ [Key in Tag]: Name } & Messages[Name]>;
};
