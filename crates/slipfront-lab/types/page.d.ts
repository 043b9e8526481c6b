// Types of the page beside those of the protocol. Browsers are not given this file.
import {
  CalibratingReply, CaseKeys, Field, FindingReply, RecordCurve, RecordedReply, RecordFile, Replies, Requests, ViewChange,
} from './protocol';

/** A request as it is sent. */
export type Request = { [Name in keyof Requests]: { do: Name } & Requests[Name] }[keyof Requests];

/** A reply as it comes. */
export type Reply = { [Name in keyof Replies]: { is: Name } & Replies[Name] }[keyof Replies];

/** A picture of the field: one byte for each block. */
export interface FieldPicture {
  field: Field;
  unit: string;
  recorded: boolean;
  number: number;
  step: number;
  tStar: number;
  muStar: number;
  slidingPercent: number;
  low: number;
  high: number;
  nx: number;
  ny: number;
  bytes: Uint8Array;
}

/** What slides where and when: one byte for each of `rows` instants and `bins` places. */
export interface KymographPicture {
  rows: number;
  bins: number;
  firstStar: number;
  lastStar: number;
  edgeBlocks: number;
  binBlocks: number;
  bytes: Uint8Array;
}

export type Tool = 'probe' | 'brush' | 'eraser' | 'circle' | 'ellipse' | 'polygon' | 'groove' | 'array';

/** A step of a lesson. */
export interface LessonPlace {
  lesson: string;
  step: number;
}

/** Values of a sentence by their names in en.json. */
export type Words = Record<string, string | number>;

/** A measured record beside the curve. */
export interface Measured {
  file: RecordFile;
  /** Its values, in the order of their times or displacements. */
  curve: RecordCurve;
  /** Added to times or displacements, s or m. */
  shift: number;
}

/** What the store holds: what the server tells, and what the page decides itself. */
export interface Topics extends Omit<Replies, 'recorded' | 'finding' | 'calibrating'> {
  recorded: RecordedReply | null;
  /** The search that is under way. */
  finding: FindingReply | null;
  /** The calibration that is under way. */
  calibrating: CalibratingReply | null;
  measured: Measured | null;
  picture: FieldPicture;
  kymograph: KymographPicture;
  connected: { yes: boolean; ended?: boolean; reason?: string };
  problem: { key: string; values?: Words };
  announcement: string;
  theme: string;
  view: Required<ViewChange>;
  tool: Tool;
  /** The place of the selected texture, from 0. */
  selected: number | null;
  lesson: LessonPlace | null;
}

/** The store: the view, the tool and the selection are there from the beginning. */
export type State = Partial<Topics> & Pick<Topics, 'view' | 'tool' | 'selected'>;

/** A lesson as lessons.json has it. */
export interface Lesson {
  id: string;
  steps: LessonStep[];
}

export interface LessonStep {
  id: string;
  case: string;
  /** A measured record that the reader can load. */
  record?: string;
  view: ViewChange;
  set?: { id: string; keys?: CaseKeys; view?: ViewChange }[];
}

/** The words of a lesson as lessons.en.json has them. */
export interface LessonWords {
  title: string;
  minutes: number;
  summary: string;
  steps: Record<string, { title: string; text: string[]; answer: string[]; set?: Record<string, string> }>;
}

/** The elements of index.html that are more than an HTMLElement, by their ids. */
export interface Elements {
  'open-presets': HTMLButtonElement;
  'open-lessons': HTMLButtonElement;
  pause: HTMLButtonElement;
  step: HTMLButtonElement;
  rest: HTMLButtonElement;
  undo: HTMLButtonElement;
  redo: HTMLButtonElement;
  pace: HTMLInputElement;
  'clip-running': HTMLButtonElement;
  'open-keep': HTMLButtonElement;
  theme: HTMLButtonElement;
  'open-help': HTMLButtonElement;
  more: HTMLButtonElement;
  'story-off': HTMLButtonElement;
  'tool-image': HTMLButtonElement;
  'image-file': HTMLInputElement;
  'brush-size': HTMLInputElement;
  'option-w': HTMLInputElement;
  'polygon-close': HTMLButtonElement;
  'option-s': HTMLInputElement;
  'option-sharp': HTMLInputElement;
  'option-orientation': HTMLSelectElement;
  'option-columns': HTMLInputElement;
  'option-rows': HTMLInputElement;
  canvas: HTMLCanvasElement;
  overlay: HTMLCanvasElement;
  'zoom-in': HTMLButtonElement;
  'zoom-out': HTMLButtonElement;
  'zoom-all': HTMLButtonElement;
  replay: HTMLInputElement;
  bar: HTMLCanvasElement;
  field: HTMLSelectElement;
  colourmap: HTMLSelectElement;
  'next-paint': HTMLButtonElement;
  'next-repeat': HTMLButtonElement;
  'next-find': HTMLButtonElement;
  repeat: HTMLButtonElement;
  'repeat-seeds': HTMLInputElement;
  'repeat-progress': HTMLProgressElement;
  summary: HTMLDetailsElement;
  'open-measure': HTMLButtonElement;
  shift: HTMLInputElement;
  'fit-shift': HTMLButtonElement;
  'open-calibrate': HTMLButtonElement;
  'calibrating-progress': HTMLProgressElement;
  'calibrating-stop': HTMLButtonElement;
  'show-calibrated': HTMLButtonElement;
  kymograph: HTMLCanvasElement;
  mesh: HTMLDetailsElement;
  'lesson-close': HTMLButtonElement;
  'lesson-answer': HTMLDetailsElement;
  'lesson-previous': HTMLButtonElement;
  'lesson-next': HTMLButtonElement;
  'controls-fold': HTMLDetailsElement;
  'after-rest': HTMLInputElement;
  'after-go-on': HTMLInputElement;
  find: HTMLButtonElement;
  'find-progress': HTMLProgressElement;
  presets: HTMLDialogElement;
  'presets-search': HTMLInputElement;
  'open-run': HTMLButtonElement;
  'run-folder': HTMLInputElement;
  lessons: HTMLDialogElement;
  keep: HTMLDialogElement;
  'copy-link': HTMLButtonElement;
  'download-case': HTMLButtonElement;
  'save-form': HTMLFormElement;
  'save-name': HTMLInputElement;
  save: HTMLButtonElement;
  'drawing-dxf': HTMLButtonElement;
  'drawing-svg': HTMLButtonElement;
  'png-field': HTMLButtonElement;
  'png-curves': HTMLButtonElement;
  'png-kymograph': HTMLButtonElement;
  clip: HTMLButtonElement;
  measure: HTMLDialogElement;
  'choose-record': HTMLButtonElement;
  'remove-record': HTMLButtonElement;
  'record-file': HTMLInputElement;
  'measure-columns': HTMLFormElement;
  'record-x': HTMLSelectElement;
  'record-x-unit': HTMLInputElement;
  'record-y': HTMLSelectElement;
  'record-y-unit': HTMLInputElement;
  'read-again': HTMLButtonElement;
  calibrate: HTMLDialogElement;
  'calibrate-form': HTMLFormElement;
  'calibrate-from': HTMLInputElement;
  'calibrate-to': HTMLInputElement;
  'calibrate-noise': HTMLInputElement;
  'calibrate-runs': HTMLInputElement;
  'calibrate-start': HTMLButtonElement;
  calibrated: HTMLDialogElement;
  'use-numbers': HTMLButtonElement;
  'use-and-find': HTMLButtonElement;
  'download-calibration': HTMLButtonElement;
  'calibration-more': HTMLDetailsElement;
  help: HTMLDialogElement;
}
