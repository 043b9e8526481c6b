// Holds the messages of `samples.ts` against the types of the page: they have these types, and show all that
// the types allow.
import { CaseValue, Replies, Requests, Texture } from './protocol';
import { replies, requests, textures } from './samples';

/** Values of the keys of objects, and elements of lists: of each of a union. */
type Values<T> = T extends T ? T[keyof T] : never;
type Elements<T> = T extends (infer Element)[] ? Element : never;

/** The keys that an interface names; others that it allows are left out. */
type Named<T> = { [Key in keyof T as string extends Key ? never : number extends Key ? never : Key]: T[Key] };

/** Places in a declared type of which the samples show no value, or not each word. */
type Missing<Declared, Shown, At extends string> =
  // What values of a case and textures are is the case file's: textures have samples of their own.
  [CaseValue] extends [Declared] ? never
  : [Declared] extends [Texture[]] ? never
  : Declared extends boolean ? (Extract<Shown, boolean> extends never ? At : never)
  : Declared extends (infer Element)[] ? Missing<Element, Elements<Shown>, `${At}[]`>
  : Declared extends object
    ? (string extends keyof Declared ? Missing<Declared[keyof Declared], Values<Extract<Shown, object>>, `${At}{}`> : never)
      | MissingKeys<Named<Declared>, Extract<Shown, object>, At>
  : Extract<Shown, Declared> extends never ? (Declared extends string ? `${At}: ${Declared}` : At)
  : never;

/** Such places in an object; a key that may be absent is, in some sample. */
type MissingKeys<Declared, Shown, At extends string> = Values<{
  [Key in keyof Declared & string]-?:
    | Missing<Exclude<Declared[Key], undefined>, Shown extends { [K in Key]: infer Value } ? Value : never, `${At}.${Key}`>
    | ({} extends Pick<Declared, Key> ? (Exclude<Shown, { [K in Key]: unknown }> extends never ? `${At}.${Key}?` : never) : never);
}>;

/** Such places in the messages of one direction. */
type MissingIn<Messages, Shown extends { [Name in keyof Messages]: unknown }> = Values<{
  [Name in keyof Messages & string]: Missing<Messages[Name], Elements<Shown[Name]>, Name>;
}>;

/** There is no such place. */
export const missing: never[] = [] as (
  | MissingIn<Requests, typeof requests>
  | MissingIn<Replies, typeof replies>
  | Missing<Texture, Elements<typeof textures>, 'texture'>
)[];
