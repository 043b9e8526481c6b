// @ts-check
// The files of a ZIP archive.

const END = 0x06054b50;
const ENTRY = 0x02014b50;
const END_BYTES = 22;
const ENTRY_BYTES = 46;
const LOCAL_BYTES = 30;
const STORED = 0;
const DEFLATED = 8;

/** A file of an archive, which is unpacked when it is read. @typedef {{size: number, arrayBuffer: () => Promise<ArrayBuffer>}} Packed */

/** Unpacks a file; throws if it has not the size that the archive tells, so that no more is unpacked. @param {Blob} packed @param {number} size */
async function unpack(packed, size) {
  const bytes = new Uint8Array(size);
  let filled = 0;
  const reader = packed.stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    // It throws beyond the end.
    bytes.set(value, filled);
    filled += value.length;
  }
  if (filled !== size) throw new RangeError('not its size');
  return bytes.buffer;
}

/** The bytes of a file whose local header begins at `start`. @param {Blob} archive @param {{method: number, start: number, length: number, size: number}} entry */
async function read(archive, { method, start, length, size }) {
  const header = new DataView(await archive.slice(start, start + LOCAL_BYTES).arrayBuffer());
  const from = start + LOCAL_BYTES + header.getUint16(26, true) + header.getUint16(28, true);
  const packed = archive.slice(from, from + length);
  if (method === DEFLATED) return unpack(packed, size);
  if (method !== STORED || length !== size) throw new RangeError('packed in another way');
  return packed.arrayBuffer();
}

/** The files of an archive by their paths; throws if it is none. @param {Blob} archive @returns {Promise<Map<string, Packed>>} */
export async function filesOfZip(archive) {
  const tail = new DataView(await archive.slice(-0xffff - END_BYTES).arrayBuffer());
  let end = tail.byteLength - END_BYTES;
  while (tail.getUint32(end, true) !== END) end -= 1;
  const [count, length, start] = [tail.getUint16(end + 10, true), tail.getUint32(end + 12, true), tail.getUint32(end + 16, true)];
  const list = new DataView(await archive.slice(start, start + length).arrayBuffer());
  /** @type {Map<string, Packed>} */
  const files = new Map();
  for (let at = 0, k = 0; k < count; k += 1) {
    if (list.getUint32(at, true) !== ENTRY) throw new RangeError('not an entry');
    const [name, extra, comment] = [28, 30, 32].map((offset) => list.getUint16(at + offset, true));
    const path = new TextDecoder().decode(new Uint8Array(list.buffer, at + ENTRY_BYTES, name));
    const entry = { method: list.getUint16(at + 10, true), length: list.getUint32(at + 20, true), size: list.getUint32(at + 24, true), start: list.getUint32(at + 42, true) };
    files.set(path, { size: entry.size, arrayBuffer: () => read(archive, entry) });
    at += ENTRY_BYTES + name + extra + comment;
  }
  return files;
}
