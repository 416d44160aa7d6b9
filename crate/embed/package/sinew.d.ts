/** A point or a direction: x, y, z. */
export type Vector = [number, number, number];

/** Who sees the model. */
export interface Camera {
  /** The eye. */
  eye: Vector;
  /** The point in the middle of the picture. */
  target: Vector;
  /** The direction that is up in the picture. */
  up: Vector;
  /** Horizontal angle of view, degrees. */
  fov: number;
  /** Shift of the picture across the view, in halves of its width. */
  shift?: [number, number];
  /** Height of a pixel over its width. */
  pixel?: number;
}

/** A message about a text. */
export interface Diagnostic {
  severity: 'error' | 'warning' | 'note';
  /** The mistake in a sentence. */
  message: string;
  /** What to do. */
  hint: string | null;
  file: string;
  /** From 1. */
  line: number;
  /** In characters, from 1. */
  column: number;
  /** Bytes of the file. */
  span: { start: number; end: number };
}

/** Options of all that takes long. */
export interface Waiting {
  /** Gives it up; its promise is rejected with the signal's reason. */
  signal?: AbortSignal;
  /** Hears how far it is. */
  onProgress?: (progress: { fraction: number; remaining?: number | null }) => void;
}

/** Options of a picture. */
export interface PictureOptions extends Waiting {
  /** Pixels; those of the text if not given. */
  width?: number;
  height?: number;
  /** What differs from the text's camera. */
  camera?: Partial<Camera>;
  /** Gets the picture while it becomes sharper. */
  onPicture?: (image: ImageData) => void;
}

/** Options of a mesh. */
export interface MeshOptions extends Waiting {
  /** Largest distance between mesh and surface, as a share of the model's longest side: 0.0015. */
  tolerance?: number;
  /** Whether bodies that overlap become one. */
  union?: boolean;
  /** Whether what can be proved of the mesh is, which takes ten times as long. */
  prove?: boolean;
}

/** Options of a mesh's file. */
export interface FileOptions extends MeshOptions {
  /** `glb` if not given. */
  format?: 'stl' | '3mf' | 'glb' | 'obj' | 'ply';
  /** Length of the longest side, millimetres: 100. With 0 a unit of the text is a millimetre. */
  size?: number;
}

/** A part of a mesh: the triangles of one body. */
export interface Part {
  name: string;
  /** Three numbers a vertex, in units of the text. */
  positions: Float32Array;
  /** Three numbers a vertex; null if the triangles are flat. */
  normals: Float32Array | null;
  /** Linear RGB, three numbers a vertex. */
  colors: Float32Array | null;
  /** Three vertices a triangle, counter-clockwise seen from outside. */
  indices: Uint32Array;
}

/** Facts of a mesh, its parts together; lengths in millimetres of a longest side of 100. */
export interface Facts {
  triangles: number;
  vertices: number;
  is_closed: boolean;
  shells: number;
  volume: number;
  sides: Vector;
  error: number;
  crossings: number;
  notes: string[];
}

/** A model that a text makes. */
export interface Model {
  readonly diagnostics: Diagnostic[];
  /** Whether the text has no errors. */
  readonly ok: boolean;
  /** The number of shapes. */
  readonly elements: number;
  /** Whether the text changes from frame to frame. */
  readonly animated: boolean;
  /** The size of the text's picture, pixels. */
  readonly size: { width: number; height: number };
  /** The text's camera. */
  readonly camera: Camera;
  /** Traces a picture, in workers. */
  trace(options?: PictureOptions): Promise<ImageData>;
  /** Makes a mesh, in a worker. */
  mesh(options?: MeshOptions): Promise<{ parts: Part[]; facts: Facts }>;
  /** Makes a mesh's file, in a worker. */
  file(options?: FileOptions): Promise<Uint8Array>;
  /** Computes the field at points (x, y, z, x …): the largest of all bodies, above the iso-value inside. */
  values(points: ArrayLike<number>): Float64Array;
  /** Shows another frame of a film, from 0. */
  frame(number: number, options?: { signal?: AbortSignal }): Promise<void>;
  /** Gives the model's memory back. */
  free(): void;
}

/** A file: a text, or bytes. */
export type Content = string | Blob | ArrayBuffer | ArrayBufferView;

/** Loads the program; the other functions do so, too. Call it first where the package's files are in another folder. */
export function load(options?: { folder?: string | URL }): Promise<unknown>;
/** Makes a model of a text, or of files by their names, of which the text that no other reads is run. Mistakes in a text are its `diagnostics`; a file that is none of Sinew's is an exception. */
export function compile(files: string | Record<string, Content>, options?: { signal?: AbortSignal }): Promise<Model>;
/** Returns the field's value at the surface. */
export function isoValue(): Promise<number>;
/** Turns a camera about its target by shares of the picture's width and height. */
export function turned(camera: Camera, across: number, down: number): Promise<Camera>;
/** Brings a camera to a multiple of its distance from the target. */
export function zoomed(camera: Camera, factor: number): Promise<Camera>;
