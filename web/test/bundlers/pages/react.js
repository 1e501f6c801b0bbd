import { SlfViewerElement } from 'slf-decoder/viewer/slf_viewer.js';
import './main.jsx';

Object.assign(SlfViewerElement.parts, { /* parts */ });
