// @ts-check
// What is dropped on the page: an image as texture, a file with a case or a run, a measured record, or the
// folder of a run.
import { takeImage } from './image.js';
import { openRecord } from './measurement.js';
import { filesOf, openFile, replayWhenRead } from './run_folder.js';

/** Begins to listen. */
export function startDrop() {
  document.addEventListener('dragover', (event) => event.preventDefault());
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    const entry = event.dataTransfer?.items[0]?.webkitGetAsEntry();
    const file = event.dataTransfer?.files[0];
    if (entry?.isDirectory) replayWhenRead(entry.name, filesOf(/** @type {FileSystemDirectoryEntry} */ (entry)));
    else if (file && !openFile(file) && !openRecord(file)) takeImage(file);
  });
}
