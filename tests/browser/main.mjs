// All tests of the laboratory in one process, since they share a browser and a laboratory.
import { after } from 'node:test';
import { endAll } from './page.mjs';
import './opening.mjs';
import './controls.mjs';
import './texture.mjs';
import './find.mjs';
import './record.mjs';
import './sensitivity.mjs';
import './guidance.mjs';
import './keep.mjs';
import './replay.mjs';
import './lessons.mjs';
import './keyboard.mjs';
import './accessibility.mjs';
import './connection.mjs';
import './alone.mjs';
import './appearance.mjs';

after(endAll);
