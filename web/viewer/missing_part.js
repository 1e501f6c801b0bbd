// SPDX-License-Identifier: Apache-2.0
// What a <slf-viewer> says where made/viewer_markup.js did not arrive, which has its elements and its style.
import { ViewerError } from './packed_field.js';

const TITLE = 'Something did not arrive',
  PART = 'made/viewer_markup.js';
const STYLE = `
:host { display: block; box-sizing: border-box; overflow: auto; padding: 1rem; border: 1px solid; font: 1rem/1.5 system-ui, sans-serif }
p { margin: 0 }
`;

export const missingPart = () => new ViewerError('network', TITLE, PART);

/** In place of what a viewer shows; what its page has written into it stays. @param {import('./words.js').Words} words */
export function missingCard(root, words) {
  const sheet = new CSSStyleSheet(),
    card = document.createElement('div');
  sheet.replaceSync(STYLE);
  root.adoptedStyleSheets = [sheet];
  card.lang = words.language;
  card.setAttribute('role', 'alert');
  for (const text of [words.t(TITLE), PART]) card.appendChild(document.createElement('p')).textContent = text;
  root.replaceChildren(card, document.createElement('slot'));
}
