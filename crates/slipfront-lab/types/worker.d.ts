// The Workers of a page without a server: the functions of the WebAssembly module, and the messages between
// page and Worker.

/** The functions of a module of slipfront-wasm (`exports.rs`): the first three of every one, those up to `hear_lost` of the session, the others of work beside it. */
export interface Module {
  memory: WebAssembly.Memory;
  /** Makes room for so many bytes, and returns its address. */
  room(length: number): number;
  begin(): void;
  open(workers: number): void;
  handle(): void;
  /** Works for some time, and returns the time at which it is to be called again; below 0 for never. */
  advance(now: number, unread: number): number;
  hear(task: number): void;
  hear_lost(task: number): void;
  run(): void;
  save(): void;
}

/** A message of the page to a Worker whose module has begun. */
export type Asked =
  | { do: 'open'; text: string; workers: number }
  | { do: 'handle' | 'run' | 'save'; text: string }
  | { do: 'hear'; number: number; text: string }
  | { do: 'lost'; number: number }
  | { do: 'read'; pictures: number; messages: number };

/** The first message of the page to a Worker. */
export interface Begin {
  do: 'begin';
  module: WebAssembly.Module;
}

/** Names of the messages that the module sends as text, and of those that it sends as bytes. */
export type TextSaying = 'reply' | 'job' | 'end' | 'event' | 'save' | 'stop_saving' | 'share' | 'bits' | 'refusal' | 'defect';
export type BytesSaying = 'picture' | 'kymograph' | 'archive';

/** A message of a Worker to the page. */
export type Said = { is: TextSaying | 'done'; number: number; data: string } | { is: BytesSaying; number: number; data: ArrayBuffer };
