// SPDX-License-Identifier: Apache-2.0
import { SlfViewerElement } from 'slf-decoder/viewer/slf_viewer.js';

Object.assign(SlfViewerElement.parts, { /* parts */ });
document.body.innerHTML = '<slf-viewer src="/can.slf" background="black" style="height: 300px"></slf-viewer>';
document.querySelector('slf-viewer').addEventListener('ready', () => { window.ready = true; });
