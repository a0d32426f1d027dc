"""Types of the extension module. The package gives its functions names, units and documentation."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypedDict, final

from numpy import bool_, float64, int64, uint8
from numpy.typing import NDArray

__all__ = [
    "CheckedScene", "ComputedMap", "SceneError", "StateError", "StoredMap", "arithmetic", "axis_title", "branch", "channel_attributes", "channels", "coordinates",
    "curve", "design", "designs", "detachment", "fit", "force", "inks", "locate", "map", "parameters", "plan", "read_tracking", "regimes", "run_command", "shape", "texture", "unused_columns", "variables",
    "version", "whisk",
]

_Coordinate = tuple[str, str, NDArray[float64] | list[str]]
_Column = tuple[str, NDArray[Any] | list[str], str | None, str]
_Description = tuple[
    str,
    dict[str, float],
    tuple[list[list[float]], bool] | None,
    tuple[list[list[float]], int | None] | None,
    list[tuple[str, Any]],
    dict[str, float] | None,
    tuple[float, float, float, float, float, int] | None,
    list[tuple[str, list[tuple[str, float]], list[list[float]] | None, list[list[float]] | None]] | None,
    str | None,
]

class SceneError(ValueError):
    """A scene is refused: `key`, `value` and `allowed` say what is wrong."""

    key: str | None
    value: str | None
    allowed: str | None
    element: int

class StateError(ValueError):
    """A state of the whisker does not exist: the message says how the whisker left the pole."""

@final
class CheckedScene:
    @staticmethod
    def read(path: str) -> CheckedScene: ...
    @staticmethod
    def parse(text: str, origin: str) -> CheckedScene: ...
    @staticmethod
    def build(description: _Description, changed: set[str]) -> CheckedScene: ...
    def description(self) -> _Description: ...
    def to_toml(self) -> str: ...
    def warnings(self) -> list[str]: ...
    def refused(self) -> list[tuple[str, str]]: ...
    def whisker(self, name: str) -> CheckedScene: ...
    def rest_fit(self) -> tuple[int, float, bool] | None: ...
    def profile_fit(self) -> tuple[int, float] | None: ...
    def yield_strain(self) -> float | None: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class ComputedMap:
    def __new__(
        cls,
        scene: CheckedScene,
        engine: str,
        tolerance_deg: float | None,
        channels: Sequence[str] | None,
        threads: int | None,
    ) -> ComputedMap: ...
    def channels(self) -> list[str]: ...
    def engine(self) -> str: ...
    def warning(self) -> str | None: ...
    def read(self, channel: str, whiskers: Sequence[int]) -> tuple[NDArray[Any], list[str]]: ...

@final
class StoredMap:
    def __new__(cls, path: str) -> StoredMap: ...
    def channels(self) -> list[str]: ...
    def coordinates(self) -> list[_Coordinate]: ...
    def attributes(self) -> list[tuple[str, str]]: ...
    def warning(self) -> str | None: ...
    def read(self, channel: str, whiskers: Sequence[int]) -> NDArray[Any]: ...
    def __reduce__(self) -> tuple[type[StoredMap], tuple[str]]: ...

class _Film(TypedDict):
    format: str
    frames: list[_Column]
    detachments: list[_Column]
    points: NDArray[float64]
    counts: NDArray[int64]
    notes: list[str]
    warnings: list[str]

class _FitResult(TypedDict):
    scene: CheckedScene
    estimates: list[tuple[str, str, float, float | None, bool]]
    correlation: list[list[float | None]]
    chi_square: float
    degrees_of_freedom: int
    is_explained: bool
    not_a_fit: str | None
    is_chord: bool
    points: list[_Column]
    pulls: list[tuple[int, float, float, str, float]]
    warnings: list[str]

def version() -> str: ...
def arithmetic() -> str: ...
def unused_columns(names: Sequence[str]) -> str | None: ...
def parameters() -> list[tuple[str, str, str | None, str]]: ...
def variables(scene: CheckedScene) -> list[tuple[str, str, float]]: ...
def channels() -> list[str]: ...
def channel_attributes(name: str) -> str | None: ...
def coordinates(scene: CheckedScene) -> list[_Coordinate]: ...
def regimes() -> list[tuple[int, str, str, str]]: ...
def axis_title(name: str, is_end: bool) -> str: ...
def inks() -> dict[str, str]: ...
def run_command(arguments: Sequence[str]) -> int: ...
def map(
    scene: CheckedScene,
    engine: str,
    tolerance_deg: float | None,
    channels: Sequence[str] | None,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> tuple[list[tuple[str, NDArray[Any]]], str, str, list[str]]: ...
def plan(scene: CheckedScene) -> tuple[int, int, int | None, list[tuple[str, bool, str]]]: ...
def curve(scene: CheckedScene, tolerance_deg: float | None, threads: int | None) -> list[_Column]: ...
def branch(scene: CheckedScene, distance_mm: float, side: str, points: int) -> list[_Column]: ...
def shape(
    scene: CheckedScene, distance_mm: float, push_angle_deg: float, stable: bool, points: int
) -> tuple[list[_Column], list[float], float, float, list[_Column]]: ...
def whisk(
    scene: CheckedScene, distance_mm: float, times_and_angles: tuple[NDArray[float64], NDArray[float64]], start: str | None,
    bridge_s: float, curvature_at_mm: float | None,
) -> tuple[list[_Column], list[_Column], float, float, float, list[str]]: ...
def texture(
    scene: CheckedScene, time_s: NDArray[float64], angle_deg: NDArray[float64], curvature_at_mm: float | None
) -> tuple[list[_Column], list[_Column], list[_Column], list[_Column], float, int, str | None]: ...
def force(
    scene: CheckedScene, frames: str, origin: str, columns: Sequence[tuple[str, str]], model: bool,
    baseline_s: tuple[float, float] | None, axis: str,
) -> tuple[list[_Column], list[str], tuple[float, float, int] | None]: ...
def locate(
    scene: CheckedScene, readings: str, origin: str, columns: Sequence[tuple[str, str]], deviations: tuple[float, float] | None
) -> tuple[list[_Column], str | None]: ...
def fit(
    scene: CheckedScene, points: str, origin: str, free: Sequence[str], loss: str, columns: Sequence[tuple[str, str]]
) -> _FitResult: ...
def read_tracking(texts: Sequence[tuple[str, str]], options: Mapping[str, Any]) -> _Film: ...
def design(
    scene: CheckedScene, parameter: tuple[str, tuple[float, float] | None], goal: str, value: float,
    distance: tuple[float, bool] | None, side: str | None, keeps_taper: bool,
) -> tuple[list[float], list[float], list[float], list[str], list[float | None], list[str]]: ...
def designs(
    scene: CheckedScene, parameters: Sequence[tuple[str, tuple[float, float] | None]], targets: Sequence[tuple[str, float]],
    distance: tuple[float, bool] | None, side: str | None, keeps_taper: bool,
) -> tuple[list[list[float]], list[list[float]], bool, tuple[list[float], list[float], list[bool]] | None, list[str]]: ...
def detachment(
    scene: CheckedScene | None,
    fixed: Mapping[str, float],
    varying: Mapping[str, NDArray[float64]],
    distance_mm: NDArray[float64],
    is_cb: NDArray[bool_],
    variables: Sequence[str],
    threads: int | None,
) -> tuple[
    NDArray[uint8],
    NDArray[float64],
    NDArray[float64],
    NDArray[float64] | None,
    list[tuple[str, NDArray[float64], NDArray[float64]]],
    list[SceneError],
]: ...
