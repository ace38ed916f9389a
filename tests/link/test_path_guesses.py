"""Which path a mistyped one most likely means."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.link.path_guesses import PathGuesser, list_possible_kinds, take_path_end
from archgen.model.path_resolver import PathResolver

PATHS = {
    "group": ["sensing"],
    "component": ["sensing.camera", "sensing.lidar"],
    "output": ["sensing.camera.image", "sensing.lidar.scan"],
}


def make_guesser() -> PathGuesser:
    kinds = ("group", "component", "output", "input", "node")
    return PathGuesser(PathResolver({kind: dict.fromkeys(PATHS.get(kind, []), NO_SPAN) for kind in kinds}))


@pytest.mark.parametrize(
    ("path", "kinds", "guess"),
    [
        ("camra.image", ("output",), "camera.image"),
        ("camera.imge", ("output",), "camera.image"),
        ("lidr", ("component", "output"), "lidar"),
        # The component is right: its output is near by its own letters, or none is meant.
        ("sensing.camera.pages", ("output",), None),
        # Moved to another group: what is left of the path still names it.
        ("acting.arm.lidar.scan", ("output",), "sensing.lidar.scan"),
        ("zzz", ("component",), None),
    ],
)
def test_the_nearest_path_of_the_same_length_is_meant(path: str, kinds: tuple[str, ...], guess: str | None) -> None:
    assert make_guesser().guess_path(path, kinds) == guess


def test_kinds_that_a_path_is_too_long_for_are_not_named() -> None:
    assert list_possible_kinds(("component", "output"), 2) == "component or output"
    assert list_possible_kinds(("component", "output"), 3) == "output"
    assert take_path_end("a.b.c", 2) == "b.c"
