// What curves.js uses of uPlot. Browsers are not given this file.

/** Times and the values of each curve at them; null where there is none. */
export type Data = (number | null | undefined)[][];

export interface Options {
  width: number;
  height: number;
  padding: number[];
  legend: { show: boolean };
  cursor: object;
  scales: { x: { time: boolean }; y: Scale };
  axes: object[];
  series: Series[];
  hooks: { draw: ((plot: uPlot) => void)[]; setCursor: ((plot: uPlot) => void)[] };
}

/** The ends of an axis, or what makes them of the ends of the values. */
export interface Scale {
  range: number[] | ((plot: uPlot, low: number | null, high: number | null) => number[]);
}

export interface Series {
  label: string;
  stroke?: () => string;
  dash?: number[];
  width?: number;
  spanGaps?: boolean;
  /** Nothing in place of a line. */
  paths?: () => null;
  points?: { show: boolean; size?: number; width?: number; fill?: () => string };
}

export class uPlot {
  constructor(options: Options, data: Data, place: HTMLElement);
  static join(tables: number[][][]): Data;
  readonly root: HTMLElement;
  readonly ctx: CanvasRenderingContext2D;
  readonly bbox: { left: number; top: number; width: number; height: number };
  readonly cursor: { idx?: number | null };
  readonly data: Data;
  valToPos(value: number, scale: string, canvasPixels: boolean): number;
  setData(data: Data): void;
  setSize(size: { width: number; height: number }): void;
  destroy(): void;
  redraw(rebuildPaths: boolean, recalcAxes: boolean): void;
}
