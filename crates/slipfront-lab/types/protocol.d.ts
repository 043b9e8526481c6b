// What the page and the server say to each other, as `protocol.rs` of slipfront-session has it: `samples.ts`
// holds the two against each other. A number that is not finite is sent as null. Browsers are not given this
// file.

/** A value of a key of the case, as in TOML. */
export type CaseValue = string | number | boolean | CaseValue[] | { [key: string]: CaseValue };

/** Values of keys of the case such as `drive.v_star`; null removes a key. */
export type CaseKeys = Record<string, CaseValue | Texture[] | null>;

/** A `[[texture]]` of the case with the keys of every shape; lengths are texts such as `25 um`. */
export interface Texture {
  shape: 'cavity' | 'groove' | 'polygon' | 'mask' | 'height_map' | 'drawing';
  s?: number;
  w?: number;
  coverage?: number;
  lambda?: string;
  across?: boolean;
  center?: string | string[];
  rotate?: number;
  orientation?: string;
  width?: string;
  offset?: string;
  points?: string[][];
  file?: string;
  threshold?: number;
  bearing_percent?: number;
  depth?: string;
  reference?: string;
  height_unit?: string;
  pixel_size?: string | string[];
  level?: string;
  decimal?: string;
  separator?: string;
  missing?: number | string;
  pitch?: string | string[];
  array?: string | number[];
  lattice?: string;
  repeat?: CaseValue;
  invert?: boolean;
}

/** A field of all blocks. */
export type Field = 'contact_stress' | 'traction' | 'displacement' | 'speed' | 'sliding' | 'first_slip' | 'front';

/** How the run goes on after the case was changed. */
export type AfterChange = 'rest' | 'go_on';

/** What the page asks for, by its name under the key `do`. */
export interface Requests {
  open: OpenRequest;
  set: SetRequest;
  paint: PaintRequest;
  image: ImageRequest;
  undo: NoKeys;
  redo: NoKeys;
  rest: NoKeys;
  view: ViewChange;
  step: StepRequest;
  repeat: RepeatRequest;
  find: FindRequest;
  find_stop: NoKeys;
  save: SaveRequest;
  save_stop: SaveRequest;
  export: NoKeys;
  frames_of: FramesOfRequest;
  read_record: ReadRecordRequest;
  calibrate: CalibrateRequest;
  calibrate_stop: NoKeys;
  sensitivity: SensitivityRequest;
  drawing: DrawingRequest;
}

/** A request without keys of its own. */
export interface NoKeys {}

export interface OpenRequest {
  source: Source;
}

/** Where a case is taken from: the laboratory starts with its own if nothing is given. */
export interface Source {
  preset?: string;
  folder?: string;
  toml?: string;
  name?: string;
  /** Contents of the files that the TOML names, in Base64. */
  files?: Record<string, string>;
  /** Files of the folder of a recorded run, in Base64. */
  run?: Record<string, string>;
}

export interface SetRequest {
  keys: CaseKeys;
  gesture: number;
}

/** Blocks within a radius of a line through points become texture, or contact. Lengths are in blocks. */
export interface PaintRequest {
  points: number[][];
  radius: number;
  textured: boolean;
  gesture: number;
}

/** A PNG image in Base64 as the texture: what is darker than the threshold. */
export interface ImageRequest {
  png: string;
  threshold: number;
  gesture: number;
}

/** What changes of the view. */
export interface ViewChange {
  field?: Field;
  visible?: boolean;
  paused?: boolean;
  /** t* in a second; 0 for as fast as possible. */
  pace?: number;
  /** t* in a second until a block in contact slips, where that is faster than the pace; 0 for no such time. */
  loading_pace?: number;
  twin?: boolean;
  kymograph?: boolean;
  frames_per_second?: number;
  after_change?: AfterChange;
  /** The block that is probed; null for none. */
  probe?: number[] | null;
}

export interface StepRequest {
  count: number;
}

/** Static friction over several seeds; 0 stops it. */
export interface RepeatRequest {
  seeds: number;
}

/** A texture with less static friction than that of the present case. */
export interface FindRequest {
  gesture: number;
}

export interface SaveRequest {
  name: string;
}

/** A recorded snapshot in place of the live field, or null for the live field. */
export interface FramesOfRequest {
  index: number | null;
}

/** The file of a measured record, and the columns of its table. */
export interface RecordFile {
  name: string;
  /** The file, in Base64. */
  bytes: string;
  /** Names of the columns, or their numbers from 1; columns are chosen by their units where they are missing. */
  x?: string;
  y?: string;
  /** Units of the columns, where the table has none or other ones are meant. */
  x_unit?: string;
  y_unit?: string;
}

export interface ReadRecordRequest {
  record: RecordFile;
}

/** Estimates unknown keys of the case from a record. */
export interface CalibrateRequest {
  record: RecordFile;
  /** Added to times or displacements, s or m, so that the drive begins at 0. */
  shift: number;
  /** The part that is compared, after the shift, s or m. */
  from?: number;
  to?: number;
  /** Standard deviation of the noise, as a share of the mean friction. */
  noise: number;
  /** Number of training runs. */
  runs: number;
  /** Ranges of the unknown keys, as calibration files have them. */
  unknowns: Record<string, CaseValue>;
}

/** Change of static friction with the quantity of a slider, by the name of that quantity. */
export interface SensitivityRequest {
  control: string;
}

/** The texture as outlines for a laser or a drawing program. */
export interface DrawingRequest {
  format: 'dxf' | 'svg';
}

/** What the server tells, by its name under the key `is`. */
export interface Replies {
  hello: HelloReply;
  case: CaseReply;
  curve: CurveReply;
  numbers: NumbersReply;
  probe: ProbeReply;
  repeated: RepeatedReply;
  finding: FindingReply;
  found: FoundReply;
  saving: SavingReply;
  saved: SavedReply;
  exported: ExportedReply;
  recorded: RecordedReply;
  record: RecordReply;
  calibrating: CalibratingReply;
  calibrated: CalibratedReply;
  sensitivity: SensitivityReply;
  drawing: DrawingReply;
  refused: RefusedReply;
  failed: FailedReply;
}

export interface HelloReply {
  version: string;
  presets: PresetEntry[];
  folders: string[];
  /** The folder of results; null where there is no disk. */
  results: string | null;
  max_blocks: number;
  controls: Control[];
}

/** A case to choose. */
export interface PresetEntry {
  name: string;
  group: string;
  /** Its small picture, 32 x 32 values of half a byte, in Base64. */
  picture: string;
  /** Whether the case is the base of a study of many runs. */
  is_study: boolean;
  title: string;
}

/** A quantity with a slider. */
export interface Control {
  id: string;
  /** The key that holds it as a number. */
  key: string;
  /** The key that holds it with its unit, if there is one. */
  si_key: string | null;
  unit: string;
  min: number;
  max: number;
  logarithmic: boolean;
  whole: boolean;
}

/** A quantity as a dimensionless group and with its unit. */
export interface ControlValue {
  star: number;
  si: number | null;
}

/** The case that is shown. */
export interface CaseReply {
  name: string;
  toml: string;
  files: string[];
  link_files_bytes: number;
  blocks: number[];
  block_size_m: number;
  n_blocks: number;
  texture_percent: number;
  texture: Texture[];
  shapes: ShapeOutlines[];
  values: Record<string, ControlValue>;
  units: Units;
  dt_star: number;
  duration_star: number;
  /** Null before the peak that it is counted from. */
  kinetic_from_star: number | null;
  /** Time t* at which the onset is expected first, or that of the end of the run, if that comes before. */
  onset_star: number;
  /** Direction of the drive, degrees from x towards y; null if it turns the slider. */
  drive_degrees: number | null;
  /** Rise of mu* in one t* of the drive as long as no block slides; null if it turns the slider. */
  loading_rate: number | null;
  steady_level: number;
  can_undo: boolean;
  can_redo: boolean;
  leg: number;
  why: string;
  time_before_s: number;
  twin: boolean;
  has_memory: boolean;
  /** Which length decides how much of an answer is the mesh. */
  mesh: string;
  warnings: string[];
  /** The one of the warnings that blocks are too coarse for the outlines of the texture. */
  too_coarse: string | null;
  /** Note on what other seeds change, if it is less than static friction. */
  seeds: string | null;
  search: SearchLimits;
}

/** What a search for a better texture may find. */
export interface SearchLimits {
  /** Smallest width of a feature and of a gap. */
  width_blocks: number;
  /** Largest share of the slider that is textured, %. */
  most_percent: number;
}

/** The outlines of one texture, in blocks. */
export interface ShapeOutlines {
  /** Its place among the textures, from 0. */
  index: number;
  outlines: number[][][];
}

/** Units of the dimensionless quantities. */
export interface Units {
  time_s: number;
  displacement_m: number;
  speed_m_s: number;
  stress_pa: number;
  /** Friction force where mu* is 1, N; null if the drive turns the slider. */
  friction_n: number | null;
  /** Friction coefficient mu where mu* is 1. */
  friction_coefficient: number;
}

/** New points of the curves. */
export interface CurveReply {
  leg: number;
  from_rest: boolean;
  t: number[];
  mu: number[];
  sliding: number[];
  twin_reset: boolean;
  twin_t: number[];
  twin_mu: number[];
  recorded_t?: number[];
  recorded_mu?: number[];
}

/** The run at this instant. */
export interface NumbersReply {
  step: number;
  t_star: number;
  time_s: number;
  mu_star: number;
  sliding_percent: number;
  peak: PeakReply | null;
  twin_peak: PeakReply | null;
  change_percent: number | null;
  kinetic: number | null;
  instants: Record<string, number>;
  /** Whether every block in contact has slipped since rest. */
  crossed: boolean;
  steps_per_second: number;
  ended: boolean;
  summary: Summary | null;
}

/** The first peak of mu*, which is certain once the fall after it has been seen. */
export interface PeakReply {
  t_star: number;
  mu_star: number;
  certain: boolean;
}

/** What the page shows of `summary.json`, which has more. */
export interface Summary {
  transition: boolean;
  static_friction_star: number;
  onset_time_star: number;
  kinetic_friction_star: number | null;
  front_speed_c_s: number | null;
  front_speed_m_s: number | null;
  front_duration_star: number | null;
  nucleation_sites: number | null;
  energy_error: number;
  [key: string]: unknown;
}

/** The block under the pointer. */
export interface ProbeReply {
  block: number[];
  exists: boolean;
  textured: boolean;
  sliding: boolean;
  mu_static: number;
  mu_kinetic: number;
  contact_stress_pa: number;
  traction_pa: number;
  displacement_m: number;
  speed_m_s: number;
  first_slip_star: number | null;
}

/** Static friction over several seeds. */
export interface RepeatedReply {
  done: number;
  of: number;
  finished: boolean;
  change_percent: Estimate | null;
  with: Estimate | null;
  without: Estimate | null;
  /** How many of the runs had no transition. */
  without_transition: number;
}

/** How far the search for a better texture is. */
export interface FindingReply {
  seconds: number;
  of_seconds: number;
  /** Textures that were tried. */
  textures: number;
  /** Whether the best is compared with what is painted, on surfaces that the search has not seen. */
  compares: boolean;
  /** Change of static friction by the best so far against no texture, %, on the surfaces of the search. */
  best_percent: number | null;
  /** Strips of blocks of the best so far: the row, the first column and the one after the last. */
  best_texture: number[][];
}

/** What became of the painted texture after a search. */
export type FoundOutcome = 'replaced' | 'kept' | 'given_up' | 'failed';

/** What came of a search for a better texture. */
export interface FoundReply {
  outcome: FoundOutcome;
  /** Textures that were tried. */
  textures: number;
  /** Surfaces that the search has not seen, on which the best and what was painted were compared. */
  surfaces: number;
  /** Change of static friction by the best against no texture, %. */
  best: Estimate | null;
  /** Change of static friction by what was painted against no texture, %. */
  painted: Estimate | null;
}

/** A mean and the half width of its interval. */
export interface Estimate {
  mean: number;
  half_width: number | null;
}

/** All runs that are being saved, from whichever page. */
export interface SavingReply {
  under_way: SavingEntry[];
}

/** A run that is being saved, and the share of it that is done. */
export interface SavingEntry {
  name: string;
  share: number;
}

export interface SavedReply {
  name: string;
  folder: string;
  folders: string[];
}

/** The case as files, in Base64. */
export interface ExportedReply {
  toml: string;
  files: Record<string, string>;
  zip: string;
}

/** Snapshots of the run folder that is shown. */
export interface RecordedReply {
  times_star: number[];
}

/** A measured record. */
export interface RecordReply {
  name: string;
  columns: RecordColumn[];
  /** The record; null if the table could not be read with these columns. */
  curve: RecordCurve | null;
  /** Why there is no curve, which other columns or units may mend. */
  problem: string | null;
  /** How the table was read, and what is doubtful about it. */
  notes: string[];
}

/** A column of a table. */
export interface RecordColumn {
  name: string;
  unit: string | null;
}

/** Two columns of a table, in SI units. */
export interface RecordCurve {
  /** Places of the columns in the table, from 0. */
  columns: number[];
  along: 'time' | 'displacement';
  of: 'force' | 'coefficient';
  /** Number of values of the record; longer ones are thinned out below. */
  values: number;
  x: number[];
  y: number[];
  /** Noise by the scatter of values about their neighbours, % of the mean friction. */
  noise_percent: number;
}

/** How far a calibration is. */
export interface CalibratingReply {
  stage: 'training' | 'closest' | 'prediction' | 'other_step';
  runs: number;
  of: number;
}

/** The end of a calibration. */
export interface CalibratedReply {
  outcome: 'done' | 'stopped' | 'given_up' | 'failed';
  /** Why it has failed. */
  sentence: string | null;
  results: CalibrationResults | null;
}

export interface CalibrationResults {
  unknowns: UnknownReply[];
  /** Whether the model cannot have made the record. */
  is_refused: boolean;
  /** The report, as `slipfront calibrate` prints it. */
  report: string;
  /** The calibration file, with which `slipfront calibrate` finds the same. */
  toml: string;
  /** The median of every unknown, as keys of the case. */
  set: Record<string, CaseValue>;
}

/** An unknown key, as it was estimated. */
export interface UnknownReply {
  key: string;
  unit: string | null;
  median: number;
  /** The interval that holds the unknown with 90 %. */
  interval: number[];
  range: number[];
  /** Whether the record determines the unknown. */
  is_determined: boolean;
}

/** Static friction at two values of the quantity of a slider. */
export interface SensitivityReply {
  control: string;
  /** The two values, as the slider has them. */
  values: number[];
  /** Change of static friction mu_s* from the first value to the second, %; null without a transition. */
  percent: number | null;
}

/** The texture as a drawing. */
export interface DrawingReply {
  format: 'dxf' | 'svg';
  text: string;
  notes: string[];
}

/** A request that was refused; nothing changed. */
export interface RefusedReply {
  of: string;
  sentence: string;
}

/** A run that has failed. */
export interface FailedReply {
  sentence: string;
}
