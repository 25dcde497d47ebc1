# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that defaults, choices and options in Python's docstrings and types agree with the library's tables."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
from typing import Any, Callable

import numpy as np
import pytest
from conftest import REPOSITORY

import promin
from promin import _promin, _records, _view

DEFAULTS = _promin.list_defaults()
CHOICES = _promin.list_choices()


def quoted(text: str) -> list[str]:
    return re.findall(r'"([a-z_-]+)"', text)


def told_fields(kind: type) -> dict[str, str]:
    """Returns the docstrings below the fields of a dataclass and of its base classes, by the names of the fields."""
    (node,) = ast.parse(inspect.getsource(kind)).body
    assert isinstance(node, ast.ClassDef)
    told = {} if kind.__base__ in (None, object) else told_fields(kind.__base__)
    for field, text in zip(node.body, node.body[1:]):
        if isinstance(field, ast.AnnAssign) and isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant):
            assert isinstance(field.target, ast.Name)
            told[field.target.id] = text.value.value
    return told


def told_argument(function: Callable[..., object], name: str) -> str:
    """Returns the sentence of a docstring that begins with an argument's name."""
    text = " ".join((function.__doc__ or "").split())
    found = re.search(rf"\b{name}: (.*?)[.;](?: |$)", text)
    assert found, f"{function.__qualname__} says nothing of {name}"
    return found[1]


def default_of(function: Callable[..., object], name: str) -> Any:
    return inspect.signature(function).parameters[name].default


def test_only_one_file_uses_the_programs() -> None:
    """The others use the library, so that the programs' options can change without them."""
    folder = REPOSITORY / "python/native"
    include = re.compile(r'#include "(commands|options|output|view)/')
    assert [file.name for file in folder.iterdir() if include.search(file.read_text())] == ["command_line.cpp"]


@pytest.mark.parametrize(
    "kind",
    [
        promin.Backdrop,
        promin.Camera,
        promin.Display,
        promin.Environment,
        promin.GradientSky,
        promin.Light,
        promin.MetallicRoughness,
        promin.Phong,
        promin.Studio,
        promin.Unlit,
    ],
)
def test_records_have_the_defaults_of_the_library(kind: type) -> None:
    ours, theirs = _records.to_dict(kind()), DEFAULTS[kind.__name__]
    assert ours.keys() == theirs.keys()
    for name, value in theirs.items():
        if isinstance(value, (bool, str, type(None))):
            assert ours[name] == value, name
        else:
            assert (np.float32(ours[name]) == np.float32(value)).all(), name


def test_a_view_has_the_defaults_of_the_library() -> None:
    view, theirs = promin.View(), DEFAULTS["View"]
    assert (view.filter, view.depth) == (theirs["filter"], theirs["depth_kind"])
    assert _view.mode_of(view) == theirs["mode"]
    assert view.error_in == CHOICES["error_in"][0]
    open_ones = {"camera", "size", "crop", "max_depth", "target_error", "time_limit", "min_spp", "max_spp", "quality"}
    open_ones |= {"spp", "filter_width", "integrator", *_view.POSE}
    assert {f.name for f in dataclasses.fields(view) if f.default is None} == open_ones
    told = told_fields(promin.View)
    target = DEFAULTS["ErrorTarget"]
    assert f"a height of {DEFAULTS['height']}." in told["size"]
    assert f"None: {DEFAULTS['samples']}, or {DEFAULTS['noisy_samples']} with the integrators" in told["spp"]
    assert f"None: {theirs['max_depth']}, or {DEFAULTS['max_depth_of_glass']} with glass" in told["max_depth"]
    assert f"None: {target['min_samples']}, or {DEFAULTS['coarse_min_spp']} for a coarse target" in told["min_spp"]
    assert f"None: {target['max_samples']}." in told["max_spp"]


def test_what_is_left_open_of_a_view_is_as_the_library_has_it() -> None:
    view = _view.settle_quality(promin.View())
    record = _view.to_record(view, _records.to_dict(promin.Camera()), promin.Display(), 5)
    theirs = DEFAULTS["View"]
    assert record.keys() == theirs.keys()
    for name in theirs.keys() - {"camera", "samples_per_pixel"}:
        assert record[name] == theirs[name], name
    assert record["samples_per_pixel"] == DEFAULTS["samples"]
    asked = promin.View(target_error=DEFAULTS["ErrorTarget"]["error"])
    record = _view.to_record(asked, _records.to_dict(promin.Camera()), promin.Display(), 5)
    assert record["error_target"] == DEFAULTS["ErrorTarget"]


def test_arguments_have_the_defaults_of_the_library() -> None:
    for kind in (promin.Caster, promin.Renderer):
        assert default_of(kind.__init__, "builder") == DEFAULTS["builder"]
    assert default_of(promin.Renderer.__init__, "texture_memory") == DEFAULTS["texture_memory"]
    assert default_of(promin.Renderer.__init__, "light") == CHOICES["light"][0]
    assert np.float32(default_of(promin.Renderer.camera, "aspect_ratio")) == np.float32(DEFAULTS["aspect_ratio"])
    names = {"half": "is_half", "compression": "compression"}
    for ours, theirs in names.items():
        assert default_of(promin.Frame.save, ours) == DEFAULTS["ExrOptions"][theirs]
    assert set(names.values()) == DEFAULTS["ExrOptions"].keys()


def test_every_field_of_a_view_is_a_keyword_of_render() -> None:
    parameters = inspect.signature(promin.Renderer.render).parameters
    fields = {field.name for field in dataclasses.fields(promin.View)}
    assert parameters.keys() == {"self", "view", "aovs", "progress", "next_scene", "next_camera"} | fields
    assert all(parameters[name].default is None for name in fields)
    keywords = inspect.signature(promin.render).parameters
    own = inspect.signature(promin.Renderer.__init__).parameters.keys() - {"self", "view", "bvh", "texture_memory"}
    assert keywords.keys() == fields | own - {"expected_samples"}, "and those of a Renderer"


def test_choices_are_told_whole() -> None:
    for kind, names in (
        (promin.View, ("debug_view", "depth", "error_in", "filter")),
        (promin.Light, ("attenuation", "kind")),
        (promin.Phong, ("alpha_mode",)),
        (promin.Camera, ("projection",)),
        (promin.Display, ("tone_mapping",)),
    ):
        told = told_fields(kind)
        for name in names:
            assert sorted(quoted(told[name])) == sorted(CHOICES[name]), name
    for function, name in ((promin.Renderer.__init__, "light"), (promin.Frame.save, "compression")):
        assert quoted(told_argument(function, name)) == CHOICES[name]
    assert sorted(quoted(told_argument(promin.Caster.__init__, "builder"))) == sorted(CHOICES["builder"])
    assert quoted(told_fields(promin.View)["from_"]) == CHOICES["framing"]


def test_every_option_of_promin_render_is_in_python_or_told_of() -> None:
    document = (REPOSITORY / "docs/python.md").read_text()
    (table,) = re.findall(r"\| option of `promin render` \| in Python \|\n(.*?)\n\n", document, re.DOTALL)
    told = set(re.findall(r"`(--[a-z-]+)", "\n".join(row.split("|")[1] for row in table.splitlines())))
    keywords = {
        "--" + name.replace("_", "-")
        for function in (promin.Renderer.__init__, promin.Renderer.render)
        for name in inspect.signature(function).parameters
    }
    options = set(_promin.list_options()) - {"SCENE", "--help", "--version"}
    assert not options - keywords - told, "neither keywords nor in the table of docs/python.md"
    assert not told - options, "in the table of docs/python.md, and no options"
