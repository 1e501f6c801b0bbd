// SPDX-License-Identifier: Apache-2.0
// Addresses that lead to a view, and the lines that put it into another page.
import { fittingPose } from './view.js';

// What a link may say of another page's viewer: who links to a page chooses neither its file nor its words.
const OF_A_VIEW = ['azimuth', 'elevation', 'fov', 'zoom', 'target', 'mode', 'exposure', 'mean', 'background'];

const short = (value) => String(Number(value.toPrecision(6)));
const turned = (degrees) => ((((degrees + 180) % 360) + 360) % 360) - 180;

/** The parameters of README.md that lead to what is shown. */
export function viewParameters({ controls, stage, options, background, chosen }) {
  const { pose } = controls,
    whole = fittingPose(stage.field, pose);
  const parameters = {
    azimuth: short(turned(pose.azimuth)),
    elevation: short(pose.elevation),
    fov: short(pose.fov),
    zoom: short(whole.distance / pose.distance),
    target: pose.target.map(short).join(','),
  };
  // Options may be of an address before, and not those that the next one meets.
  if ([controls.mode, options.mode].includes('fly')) parameters.mode = controls.mode;
  if (stage.look.exposure || options.exposure) parameters.exposure = short(stage.look.exposure);
  if (stage.look.meanOnly || options.mean) parameters.mean = stage.look.meanOnly ? '1' : '0';
  if (chosen !== null) parameters.background = background.replace('#', '');
  return parameters;
}

/** An iframe for any page. */
export function embeddingOf(viewer) {
  const address = viewer.link({ ...viewParameters(viewer), embed: '1' });
  const quoted = (text) => text.replace(/[&"<>]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<iframe src="${quoted(address)}" title="${quoted(viewer.report.titleText())}" width="640" height="480" \
style="border: 0; max-width: 100%" loading="lazy" allow="fullscreen; xr-spatial-tracking"></iframe>`;
}

export const copyLink = (viewer) => copy(viewer, viewer.link(viewParameters(viewer)));
export const copyEmbedding = (viewer) => copy(viewer, embeddingOf(viewer));

/** To the clipboard; in any case into a field, from which it can be copied by hand. */
async function copy(viewer, text) {
  const field = viewer.page.at('address');
  field.value = text;
  field.hidden = false;
  field.select();
  try {
    await navigator.clipboard.writeText(text);
    viewer.report.say('Copied.');
    viewer.report.hint('Copied.');
  } catch {
    viewer.report.say('Copy it from the field.');
  }
}

/** `#can?azimuth=30`: a view of the viewer with that id. */
export function addressOf(id, parameters) {
  const address = new URL(location.href);
  address.hash = `${encodeURIComponent(id)}?${new URLSearchParams(parameters)}`;
  return address.href;
}

/** The view that the page's own address has for a viewer; null where it names none. */
export function viewOfAddress(id) {
  const [, name, view] = /^#([^?]*)\?(.+)$/.exec(location.hash) ?? [];
  if (!id || !view || (name !== id && name !== encodeURIComponent(id))) return null;
  return new URLSearchParams([...new URLSearchParams(view)].filter(([key]) => OF_A_VIEW.includes(key)));
}
