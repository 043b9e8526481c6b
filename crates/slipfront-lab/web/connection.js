// @ts-check
// The channel to the session of this page: a server on this machine, or a Worker of the page itself.
import { isAlone } from './assets.js';
import * as socket from './socket.js';
import * as worker from './worker.js';

/** @import { Request } from '../types/page' */

const channel = isAlone ? worker : socket;

/** Connects, and again after every loss. */
export const connect = () => channel.connect();

/** Sends a request, if there is a connection. @param {Request} request */
export const send = (request) => channel.send(JSON.stringify(request));
