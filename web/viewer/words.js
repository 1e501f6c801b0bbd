// SPDX-License-Identifier: Apache-2.0
// Languages: a file each in languages/, its keys the English that stands in the page and in the code. A number in
// a sentence is {} there.

const LANGUAGES = {
  de: () => import('./languages/de.js'),
  fr: () => import('./languages/fr.js'),
  es: () => import('./languages/es.js'),
  ja: () => import('./languages/ja.js'),
  zh: () => import('./languages/zh.js'),
};
const NUMBER = /[+-]?\d(?:[\d.,\u00a0\u202f]*\d)?/g;
const SHOWN = ['aria-label', 'title', 'alt'];

export class Words {
  constructor(language, texts) {
    this.language = language;
    this.texts = texts;
    this.grouped = new Intl.NumberFormat(language).format;
  }

  /** With so many digits behind the point, or what the language has there. */
  decimal(value, digits) {
    const style = { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false };
    return new Intl.NumberFormat(this.language, style).format(value);
  }

  /** A text that is unknown stays English. */
  t(text) {
    if (Object.hasOwn(this.texts, text)) return this.texts[text];
    const numbers = String(text).match(NUMBER) ?? [],
      key = String(text).replace(NUMBER, '{}');
    if (!numbers.length || !Object.hasOwn(this.texts, key)) return text;
    return this.texts[key].replaceAll('{}', () => numbers.shift());
  }

  /** All texts of an element, and those of its attributes. */
  translate(element) {
    if (this.language === 'en') return;
    const walker = document.createTreeWalker(element, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      if (node.nodeType === Node.TEXT_NODE) {
        const text = node.data.trim();
        if (text) node.data = node.data.replace(text, () => this.t(text));
        continue;
      }
      for (const name of SHOWN)
        if (node.getAttribute(name)) node.setAttribute(name, this.t(node.getAttribute(name)));
    }
  }
}

export const ENGLISH = new Words('en', {});

/** @param {readonly string[]} wanted  tags of languages, the best first ("de-CH"); English where none is there */
export async function wordsOf(wanted) {
  for (const tag of wanted) {
    const language = String(tag).toLowerCase().split('-')[0];
    if (language === 'en') return ENGLISH;
    if (!Object.hasOwn(LANGUAGES, language)) continue;
    try {
      return new Words(language, (await LANGUAGES[language]()).default);
    } catch {
      return ENGLISH; // which did not arrive is no reason to show nothing
    }
  }
  return ENGLISH;
}
