# SPDX-License-Identifier: Apache-2.0
"""Manifests: one JSON file per experiment (keys: README.md), checked before anything runs."""
import re

import options as opt
from located_json import load

# What draws the experiment (plot.py), and the keys that it needs besides label and title.
FIGURES = {
    "curves": ("captures", "rates", "grid"),  # one series per value of the grid, panels input and held out
    "deltas": ("captures", "rates", "grid"),  # one panel per evaluation angle
    "ablation": ("captures", "rates", "variants"),  # as curves, and a table of every variant against the first
    "compare": ("captures", "rates"),         # one series per codec and preset, one column per split
    "time": ("captures", "rates"),            # table of decoding times
    "views": ("captures", "rates", "view"),   # photograph and renderings of one held-out view
    "orbit": ("captures", "rates", "orbit"),  # sheet of a circle of views
    "histogram": ("captures", "rates"),       # distribution of the coefficients
    "basis": (),                              # the functions drawn; nothing is encoded
    "fit1d": (),                              # fits in one dimension; nothing is encoded
}
# key: (JSON type, default)
KEYS = {
    "label": (str, None), "title": (str, None), "figure": (str, None), "note": (str, ""),
    "captures": (list, []), "splits": (list, ["dense"]), "codecs": (list, ["raht"]), "presets": (list, ["paper"]),
    "options": (dict, {}), "grid": (dict, {}), "variants": (dict, {}), "rates": (dict, {}), "deltas": (list, [0, 10, 20, 30]),
    "images": (bool, False), "view": (int, None), "orbit": (int, None),
}
VARIED = ("curves", "deltas", "ablation")  # the figures with one series per variant
REQUIRED = ("label", "title", "figure")
TYPE_NAMES = {str: "a string", list: "a list", dict: "an object", bool: "true or false", int: "a whole number"}
LABEL = re.compile(r"(fig|tab):[a-z0-9_]+")


def _check_type(item, kind, what):
    if not isinstance(item.value, kind) or (kind is int and isinstance(item.value, bool)):
        raise item.refuse(f"{what}: {TYPE_NAMES[kind]} is expected")


def _check_choice(item, choices, what):
    if item.value not in choices or not isinstance(item.value, str):
        raise item.refuse(f'{what}: there is no "{item.value}"; there are {", ".join(choices)}')


def _check_list(located, key, check):
    values = located.value[key]
    if not values.value:
        raise values.refuse(f"{key}: the list is empty")
    seen = set()
    for item in values.value:
        check(item)
        if item.plain() in seen:
            raise item.refuse(f"{key}: {item.value} stands here twice")
        seen.add(item.plain())


def _check_string(item):
    _check_type(item, str, "captures and splits")


def _check_option(name, item, codecs, at):
    if name not in opt.options():
        raise at.refuse(f'there is no option "{name}"; there are {", ".join(opt.options())}', name)
    limits, takes = opt.options()[name]
    problem = limits.problem(item.value) if not isinstance(item.value, (dict, list)) else "one value is expected"
    if problem:
        raise item.refuse(f"{name} {item.plain()}: {problem}")
    if not set(takes) & set(codecs):
        raise at.refuse(f"none of the codecs {', '.join(codecs)} takes {name}", name)


def _check_options(located, codecs):
    options, grid = located.value.get("options"), located.value.get("grid")
    for name, item in (options.value if options else {}).items():
        _check_option(name, item, codecs, options)
        if grid and name in grid.value:
            raise options.refuse(f"{name} is in the grid as well", name)
    for name, values in (grid.value if grid else {}).items():
        _check_type(values, list, name)
        if name not in opt.options():
            _check_option(name, values, codecs, grid)
        _check_list(grid, name, lambda item: _check_option(name, item, codecs, grid))


def _check_variants(located, codecs):
    variants = located.value["variants"]
    if "grid" in located.value:
        raise located.refuse("variants: there is a grid as well; one of the two is expected", "variants")
    if located.value["figure"].value not in VARIED:
        raise located.refuse(f"variants: only the figures {', '.join(VARIED)} show them", "variants")
    if "presets" in located.value and len(located.value["presets"].value) > 1:
        raise located.refuse("presets: beside variants one is expected; a variant may name another", "presets")
    if len(variants.value) < 2:
        raise variants.refuse("variants: two or more are expected; the first is what the others are compared with")
    for name, item in variants.value.items():
        if not name.strip():
            raise variants.refuse("variants: a name is empty", name)
        _check_type(item, dict, f"variant {name}")
        for key, part in item.value.items():
            if key == "preset":
                _check_choice(part, opt.PRESETS, f"preset of {name}")
            elif key == "options":
                _check_type(part, dict, f"options of {name}")
                for option, value in part.value.items():
                    _check_option(option, value, codecs, part)
            else:
                raise item.refuse(f'variant {name}: unknown key "{key}"; there are preset, options', key)


def _check_rates(located, codecs):
    rates = located.value["rates"]
    for codec, values in rates.value.items():
        if codec not in codecs:
            raise rates.refuse(f'rates of "{codec}", which is not among the codecs {", ".join(codecs)}', codec)
        _check_type(values, list, f"rates of {codec}")
        name, limits = opt.rate(codec)

        def check(item):
            problem = limits.problem(item.value) if not isinstance(item.value, (dict, list)) else "a number is expected"
            if problem:
                raise item.refuse(f"{name} {item.plain()} of {codec}: {problem}")

        _check_list(rates, codec, check)
    for codec in codecs:
        if codec not in rates.value:
            raise rates.refuse(f"no rates of {codec}")


def _check_numbers(located):
    def angle(item):
        problem = opt.Number(0, 90).problem(item.value)
        if problem:
            raise item.refuse(f"deltas {item.plain()}: {problem}")

    if "deltas" in located.value:
        _check_list(located, "deltas", angle)
    for key, limits in (("view", opt.Number(0, 10**6, whole=True)), ("orbit", opt.Number(1, 64, whole=True))):
        if key in located.value:
            problem = limits.problem(located.value[key].value)
            if problem:
                raise located.value[key].refuse(f"{key} {located.value[key].value}: {problem}")


def check(located):
    """BadInput with the line of the first mistake; captures are looked up later (plan.py)."""
    _check_type(located, dict, "a manifest")
    for key, item in located.value.items():
        if key not in KEYS:
            raise located.refuse(f'unknown key "{key}"; there are {", ".join(KEYS)}', key)
        _check_type(item, KEYS[key][0], key)
    for key in REQUIRED:
        if key not in located.value:
            raise located.refuse(f'the key "{key}" is missing')
    _check_choice(located.value["figure"], FIGURES, "figure")
    if not LABEL.fullmatch(located.value["label"].value):
        raise located.value["label"].refuse("label: fig: or tab: and a name in lower case is expected")
    figure = located.value["figure"].value
    for key in FIGURES[figure]:
        if key not in located.value and not (key == "grid" and "variants" in located.value):
            raise located.refuse(f'figure "{figure}" needs the key "{key}"')
    lists = {"captures": _check_string, "splits": _check_string,
             "codecs": lambda item: _check_choice(item, opt.CODECS, "codecs"),
             "presets": lambda item: _check_choice(item, opt.PRESETS, "presets")}
    for key, one in lists.items():
        if key in located.value:
            _check_list(located, key, one)
    codecs = [item.value for item in located.value["codecs"].value] if "codecs" in located.value else KEYS["codecs"][1]
    _check_options(located, codecs)
    if "variants" in located.value:
        _check_variants(located, codecs)
    if "rates" in located.value:
        _check_rates(located, codecs)
    _check_numbers(located)


def read(path, name=None):
    """(Located, dict with every key) of a manifest file. BadInput where it is not sound."""
    located = load(path, name)
    check(located)
    return located, {key: located.value[key].plain() if key in located.value else default
                     for key, (_, default) in KEYS.items()}
