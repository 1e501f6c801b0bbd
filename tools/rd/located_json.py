# SPDX-License-Identifier: Apache-2.0
"""JSON that knows the line of every key and value, for messages `file:line: what`."""
import json
import re

_SPACE = re.compile(r"[ \t\r\n]*")


class BadInput(ValueError):
    """What a user gave cannot be used; str() is `file:line: what`."""


class Located:
    """One JSON value: `value` is a dict of str to Located, a list of Located, or a plain scalar.

    `line` counts from 1; `lines` holds the line of each key of a dict.
    """

    def __init__(self, value, path, line, lines=None):
        self.value, self.path, self.line, self.lines = value, path, line, lines or {}

    def refuse(self, what, key=None):
        """BadInput that points here, or at the key of that name."""
        return BadInput(f"{self.path}:{self.lines.get(key, self.line)}: {what}")

    def plain(self):
        """The value without lines."""
        if isinstance(self.value, dict):
            return {key: item.plain() for key, item in self.value.items()}
        if isinstance(self.value, list):
            return [item.plain() for item in self.value]
        return self.value


class _Parser:
    """A parser of containers alone; strings, numbers and literals are json's own."""

    def __init__(self, text, path):
        self.text, self.path, self.scalar = text, path, json.JSONDecoder(parse_constant=self._constant)

    def _constant(self, name):
        raise ValueError(f"{name} is no JSON")

    def line(self, at):
        return self.text.count("\n", 0, at) + 1

    def fail(self, at, what):
        raise BadInput(f"{self.path}:{self.line(at)}: {what}")

    def skip(self, at):
        return _SPACE.match(self.text, at).end()

    def value(self, at):
        """(Located, position behind it)"""
        at = self.skip(at)
        if self.text[at:at + 1] == "{":
            return self.container(at, "}", self.member)
        if self.text[at:at + 1] == "[":
            return self.container(at, "]", lambda at, out: self.item(at, out))
        try:
            value, end = self.scalar.raw_decode(self.text, at)
        except ValueError as error:
            self.fail(min(at, len(self.text) - 1), f"not JSON: {getattr(error, 'msg', error)}")
        return Located(value, self.path, self.line(at)), end

    def member(self, at, out):
        if self.text[at:at + 1] != '"':
            self.fail(at, "not JSON: a key in double quotes is expected")
        key, end = self.scalar.raw_decode(self.text, at)
        if key in out.value:
            self.fail(at, f'the key "{key}" stands here twice')
        out.lines[key] = self.line(at)
        end = self.skip(end)
        if self.text[end:end + 1] != ":":
            self.fail(end, 'not JSON: ":" is expected')
        out.value[key], end = self.value(end + 1)
        return end

    def item(self, at, out):
        item, end = self.value(at)
        out.value.append(item)
        return end

    def container(self, at, close, element):
        out = Located({} if close == "}" else [], self.path, self.line(at))
        at = self.skip(at + 1)
        while self.text[at:at + 1] != close:
            at = self.skip(element(at, out))
            if self.text[at:at + 1] == ",":
                at = self.skip(at + 1)
                if self.text[at:at + 1] == close:
                    self.fail(at, f'not JSON: "{close}" after a comma')
            elif self.text[at:at + 1] != close:
                self.fail(at, f'not JSON: "," or "{close}" is expected')
        return out, at + 1


def load(path, name=None):
    """The file as Located; `name` is what messages call it. BadInput where it cannot be read."""
    name = name or str(path)
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{name}:1: cannot be read: {error}") from None
    parser = _Parser(text, name)
    try:
        located, end = parser.value(0)
    except RecursionError:
        raise BadInput(f"{name}:1: nested too deeply") from None
    if parser.skip(end) != len(text):
        parser.fail(parser.skip(end), "not JSON: something follows the value")
    return located
