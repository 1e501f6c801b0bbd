// What viewer.html runs.
import { Viewer } from './viewer.js';

window.viewer = new Viewer();
