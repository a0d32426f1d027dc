"""Warnings about scenes and results, at the lines that call the package; missing extras."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from importlib import import_module
from types import FrameType


class SceneWarning(UserWarning):
    """Values that look wrong, assumptions, and results that are incomplete: what the program prints as a warning."""


def warn(texts: Iterable[str | None]) -> None:
    """Issue each text as a warning at the innermost line outside of the package, so that Python shows it once a place."""
    frame: FrameType | None = sys._getframe(1)
    level = 2
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "whiskmap":
        frame, level = frame.f_back, level + 1
    for text in texts:
        if text is not None:
            warnings.warn(text, SceneWarning, stacklevel=level)


def require(module: str, extra: str) -> None:
    """Import a module that belongs to an extra of the package.

    Raises
    ------
    ImportError
        If the module is missing; the message names the extra.
    """
    try:
        import_module(module)
    except ImportError as why:
        text = f"{module} is missing: install the extra `{extra}` of whiskmap, as by pip install './python[{extra}]'"
        raise ImportError(text, name=module) from why
