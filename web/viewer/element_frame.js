// SPDX-License-Identifier: Apache-2.0
// The frame of <slf-viewer>: its elements and its style.

let sheet = null; // one for all of a page

/** A sleeping frame in the root, in place of what was there. @param {{markup: string, style: string}} made */
export function frameIn(root, { markup, style }) {
  if (!sheet) {
    sheet = new CSSStyleSheet();
    sheet.replaceSync(style);
  }
  root.adoptedStyleSheets = [sheet];
  const frame = document.createElement('div');
  frame.className = 'frame asleep';
  frame.innerHTML = markup;
  root.replaceChildren(frame);
  return frame;
}
