// SPDX-License-Identifier: Apache-2.0
import { createElement as element } from 'react';
import { createRoot } from 'react-dom/client';
import { LightField } from './LightField.jsx';

const ready = () => { window.ready = true; };
createRoot(document.body.appendChild(document.createElement('div')))
  .render(element(LightField, { src: '/can.slf', title: 'A can', background: 'black', loading: 'eager', onReady: ready }));
