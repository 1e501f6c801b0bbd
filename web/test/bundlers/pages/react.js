// SPDX-License-Identifier: Apache-2.0
import { SlfViewerElement } from 'slf-decoder/viewer/slf_viewer.js';
import './main.jsx';

Object.assign(SlfViewerElement.parts, { /* parts */ });
