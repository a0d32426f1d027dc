"""Files of whisker trackers: frames for `whisk` and `force`, shapes for scenes, detachments for `fit`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np
import xarray as xr

from whiskmap import _whiskmap
from whiskmap._datasets import variables
from whiskmap._values import csv_text, number, numbers, whole
from whiskmap._warnings import require, warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

    PathLike = Union[str, os.PathLike[str]]

# First bytes of an HDF5 file, and so of an NWB file.
_HDF5 = b"\x89HDF\r\n\x1a\n"


@dataclass(frozen=True)
class Tracking:
    """Whisker of a film, frame by frame.

    Attributes
    ----------
    frames : xarray.Dataset
        Frames by `time_s`, from the first to the last one, as `force` takes them. `angle_deg` is the angle of the base for `whisk`,
        `curvature_per_mm` the curvature at `at_arc_length_mm`, and `contact` is 1 or 0, or NaN where it is not known. Numbers of gaps are NaN, with a `reason`: "missing"
        (the tracker has lost the whisker or its base, or has too few points) or "no-curve" (the points lie along no smooth curve).
    notes : list of str
        What was found: the base, a mirrored image, the degree of curves, gaps.
    format : str
        Format of the file: "deeplabcut", "whisk" (also from NWB) or "xy".
    """

    frames: xr.Dataset
    notes: list[str]
    format: str
    # None without a pole.
    _detachments: xr.Dataset | None = field(repr=False)
    # Points of all frames one after the other, `[point][x, y]`, and the index at which each frame begins, `[frame]`, with the end of the last.
    _points: NDArray[np.float64] = field(repr=False)
    _begins: NDArray[np.int64] = field(repr=False)

    @property
    def detachments(self) -> xr.Dataset:
        """Detachments from the pole by `number`, as `fit` takes them: `side`, `distance_mm`, `push_angle_deg` and `time_s`.

        Raises
        ------
        ValueError
            If the film was read without `pole`.
        """
        if self._detachments is None:
            raise ValueError("detachments: pole and contact_within_mm must be given to read_tracking, as they show when the whisker leaves the pole")
        return self._detachments

    def shape(self, frame: int) -> NDArray[np.float64]:
        """Return the traced points of a frame from base to tip, of shape (points, 2), in mm, for `rest_points` of a `Whisker`.

        Raises
        ------
        ValueError
            If the frame is a gap or there is none of this number, or the format has no points.
        TypeError
            If the frame is no whole number.
        """
        number = whole("frame", frame)
        first, last = (int(self.frames["frame"][end]) for end in (0, -1))
        if not first <= number <= last:
            raise ValueError(f"frame = {number}: must be between {first} and {last}, the numbers of the frames")
        if self.format == "whisk":
            raise ValueError(f"frame = {number}: has no points: measurements of whisk are without points along the whisker")
        begin, end = self._begins[number - first :][:2]
        if begin == end:
            raise ValueError(f"frame = {number}: must be a frame with a whisker: this one is a gap")
        return self._points[begin:end].copy()


def read_tracking(
    files: PathLike | Sequence[PathLike],
    *,
    mm_per_pixel: float,
    fps: float,
    format: Literal["deeplabcut", "whisk", "xy"] | None = None,
    whisker: int | None = None,
    points: Sequence[str] = (),
    likelihood: float | None = None,
    follicle_px: Sequence[float] | None = None,
    curvature_at_mm: float | None = None,
    fit_to_mm: float | None = None,
    degree: int | None = None,
    mirror: bool | None = None,
    face_axis: Literal["x", "y"] | None = None,
    pole: str | Sequence[float] | None = None,
    contact_within_mm: float | None = None,
    taper: float | None = None,
    zero_s: float | None = None,
) -> Tracking:
    """Read the file of a whisker tracker. Positions in it are in pixels, and the y axis of the image points downward.

    Parameters
    ----------
    files : path or sequence of paths
        A CSV file of DeepLabCut, measurements of Janelia's `whisk` as CSV, an NWB file with a `WhiskerMeasurementTable` of ndx-whisk (extra
        `nwb`), or points ``x,y``, a file for each frame, or ``frame,x,y``. The number of a frame is the only number in which the names
        of files or images differ.
    mm_per_pixel : float
        Scale of the image.
    fps : float
        Frames per second.
    format : {"deeplabcut", "whisk", "xy"}, optional
        Format of the file, which is recognised if left out.
    whisker : int, optional
        Identity of the whisker in measurements of `whisk`; needed if there are several.
    points : sequence of str
        Body parts of DeepLabCut along the whisker, from base to tip. If left out, they are all but the pole, and their order is found.
    likelihood : float, optional
        Least likelihood of a point of DeepLabCut; points below it are lost. 0.9 if left out. Other formats have no likelihoods.
    follicle_px : (x, y), optional
        Position of the follicle: the end that is nearer to it is the base. If left out, the base is the end that moves less.
    curvature_at_mm : float, optional
        Arclength from the base at which the curvature is given; a quarter of the median length if left out.
    fit_to_mm : float, optional
        Distance from the base up to which points give base angle and curvature: 0.6 of the median length, or as far as 8 points reach, if left
        out. A distance selects polynomials, also with `pole`.
    degree : int, optional
        Degree of the curvature of the curves through the points of a frame, or with `pole` of the rod at rest, 0 to 6; chosen if left out.
    mirror : bool, optional
        Whether to mirror the image. If left out, it is mirrored if the whisker turns clockwise from base to tip.
    face_axis : {"x", "y"}, optional
        Axis of the image from which the angles of `whisk` are measured; found if left out.
    pole : (x, y) or str, optional
        Centre of the pole in pixels, or the body part of DeepLabCut that is its centre; needed for contacts and `detachments`.
    contact_within_mm : float, optional
        Largest distance of the whisker from the pole's centre in contact; needed with `pole`.
    taper : float, optional
        Taper of the traced whisker, ``1 - r_tip/r_base``, 0 to 1; found from frames in contact if left out. It needs `pole`.
    zero_s : float, optional
        Time of the frame in which the angle of the base is 0. If left out, it is first touch on CB, or else the first frame with a whisker.

    Returns
    -------
    Tracking

    Raises
    ------
    ValueError
        If the file has no known format, a cell is no number, an option is out of its range or does not fit the format, or both ends of the
        whisker move alike.
    OSError
        If a file cannot be read.
    ImportError
        If an NWB file is read without the extra `nwb`.

    Warns
    -----
    SceneWarning
        If the pole, an option or the points do not fit, points are few, a body part is lost in all frames, or contacts are not known.
    """
    paths = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    if isinstance(points, str):
        raise TypeError(f"points = {points!r}: must be a list of names")
    options = {
        "format": format,
        "mm_per_pixel": number("mm_per_pixel", mm_per_pixel),
        "fps": number("fps", fps),
        "whisker": None if whisker is None else whole("whisker", whisker),
        "points": list(points),
        "likelihood": None if likelihood is None else number("likelihood", likelihood),
        "follicle_px": None if follicle_px is None else _pair("follicle_px", follicle_px),
        "curvature_at_mm": None if curvature_at_mm is None else number("curvature_at_mm", curvature_at_mm),
        "fit_to_mm": None if fit_to_mm is None else number("fit_to_mm", fit_to_mm),
        "degree": None if degree is None else _degree(degree),
        "mirror": mirror,
        "face_axis": face_axis,
        "pole": pole if pole is None or isinstance(pole, str) else _pair("pole", pole),
        "contact_within_mm": None if contact_within_mm is None else number("contact_within_mm", contact_within_mm),
        "taper": None if taper is None else number("taper", taper),
        "zero_s": None if zero_s is None else number("zero_s", zero_s),
    }
    film = _whiskmap.read_tracking([(_text(Path(path)), os.fspath(path)) for path in paths], options)
    warn(film["warnings"])
    detachments = None if pole is None else xr.Dataset(variables(film["detachments"], ("number",), (-1,)))
    return Tracking(
        frames=xr.Dataset(variables(film["frames"], ("time_s",), (-1,))).set_coords("time_s"),
        notes=film["notes"],
        format=film["format"],
        _detachments=detachments,
        _points=film["points"].reshape(-1, 2),
        _begins=np.append(0, np.cumsum(film["counts"])),
    )


def _degree(value: Any) -> int:
    degree = whole("degree", value)
    if degree < 0:
        raise ValueError(f"degree = {degree}: must be between 0 and 6")
    return degree


def _pair(name: str, values: Any) -> list[float]:
    pair = numbers(name, values)
    if len(pair) != 2:
        raise ValueError(f"{name}: must be x and y in pixels, has {len(pair)} numbers")
    return pair


def _text(path: Path) -> str:
    """Return the text of a CSV file, or the measurements in an NWB file as such a text."""
    with path.open("rb") as file:
        if file.read(len(_HDF5)) != _HDF5:
            return csv_text("files", path)
    # The library of ndx-whisk registers the type of its tables.
    for module in ("pynwb", "ndx_whisk"):
        require(module, "nwb")
    pynwb: Any = import_module("pynwb")
    with pynwb.NWBHDF5IO(os.fspath(path), mode="r", load_namespaces=True) as io:
        tables = [own for own in io.read().objects.values() if getattr(own, "neurodata_type", None) == "WhiskerMeasurementTable"]
        if len(tables) != 1:
            raise ValueError(f"{path}: must have one WhiskerMeasurementTable of ndx-whisk, has {len(tables)}")
        return csv_text("files", {name: np.asarray(tables[0][name].data[:]) for name in tables[0].colnames})
