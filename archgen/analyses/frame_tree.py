"""Do the coordinate frames make one tree, with a writer for each, and do all who name a frame name one of them?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import islice

from archgen.diagnostics import Diagnostic, Label, Severity, Span, find_closest, join_words, keep_first
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component_nesting import list_described_outputs
from archgen.model.coordinate_frames import Frame, walk_ancestors

_MAX_LISTED = 6
"""So many frames of a circle are named, and so many places of it shown."""
_MAX_COMPARISONS = 300_000
"""How many names may be compared with unknown ones in one run, as for other references."""
_MAX_DEPTH = 200
"""So far up the tree a frame is looked for."""
_CHAIN = ("earth", "map", "odom", "base_link")
"""The frames of REP 105 (https://www.ros.org/reps/rep-0105.html), each placed in the one before it."""
_COMMON_WORDS = frozenset({"earth", "map"})


class _NamedFrame(NamedTuple):
    """A name of a frame where it is written, and the element that names it; `own_name` is that of a frame."""

    name: str
    span: Span
    element: str
    own_name: str = ""


def unknown_frame(architecture: Architecture) -> Iterator[Diagnostic]:
    """A frame is named that is not among the project's."""
    # A slice that could not be read may declare any of them.
    if not architecture.frames or architecture.partial or "frames" in architecture.unread_keys:
        return
    comparisons_left = _MAX_COMPARISONS
    for named_frame in _list_named_frames(architecture):
        name = named_frame.name
        if name not in architecture.frames and name not in architecture.unread_keys:
            comparisons_left -= len(architecture.frames)
            # A frame that is nearly called so itself is not meant: nothing stands in itself.
            frames = architecture.frames if comparisons_left > 0 else ()
            guess = find_closest(name, (each for each in frames if each != named_frame.own_name))
            yield _diagnose_unknown(architecture.frames, named_frame, guess)


def _list_named_frames(architecture: Architecture) -> Iterator[_NamedFrame]:
    """Yield each name of a frame that is written somewhere."""
    for frame in architecture.frames.values():
        if frame.parent is not None:
            yield _NamedFrame(frame.parent, frame.parent_at, frame.answering_element, frame.id)
    for port in architecture.list_ports():
        if port.frame is not None:
            yield _NamedFrame(port.frame, port.frame_at, port.component)
    for component, output in list_described_outputs(architecture):
        promise = output.promise
        if promise is not None and promise.frame is not None:
            yield _NamedFrame(promise.frame, promise.places.get("frame", promise.at), component.id)
    for conceptual_type in architecture.types.values():
        if conceptual_type.frame is not None:
            yield _NamedFrame(conceptual_type.frame, conceptual_type.frame_at, conceptual_type.name)


def _diagnose_unknown(frames: Mapping[str, Frame], named_frame: _NamedFrame, guess: str | None) -> Diagnostic:
    name = named_frame.name
    return Diagnostic(
        "unknown-frame",
        f"no frame named `{name}`",
        named_frame.span,
        labels=(Label(frames[guess].at, "declared here"),) if guess else (),
        help=f"did you mean `{guess}`?" if guess else f"declare it: `frames: {{{name}: {{parent: ...}}}}`",
        element=named_frame.element,
    )


def circular_frames(architecture: Architecture) -> Iterator[Diagnostic]:
    """Frames stand in one another in a circle."""
    judged_names: set[str] = set()
    for name in architecture.frames:
        way: dict[str, Frame] = {}
        frame = architecture.frames.get(name)
        # Up to what was judged: from there on every way is known.
        while frame and frame.id not in judged_names and frame.id not in way:
            way[frame.id] = frame
            frame = architecture.frames.get(frame.parent) if frame.parent is not None else None
        if frame and frame.id in way:
            circle = [*way.values()]
            yield _diagnose_circle(circle[circle.index(frame) :])
        judged_names.update(way)


def _diagnose_circle(circle: list[Frame]) -> Diagnostic:
    first_frame, *others = circle
    if not others:
        message = f"the frame `{first_frame.id}` stands in itself"
    else:
        names = keep_first([f"`{frame.id}`" for frame in circle], _MAX_LISTED)
        message = f"the frames {join_words(names)} stand in one another"
    return Diagnostic(
        "circular-frames",
        message,
        first_frame.parent_at,
        labels=tuple(
            Label(frame.parent_at, f"`{frame.id}` stands in `{frame.parent}`") for frame in others[:_MAX_LISTED]
        ),
        help="take out the `parent` of the one that is the root, or name the right one",
        element=first_frame.answering_element,
    )


def unpublished_frame(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nobody writes a frame."""
    for frame in architecture.frames.values():
        if frame.parent is not None and frame.by is None and not frame.by_written:
            yield Diagnostic(
                "unpublished-frame",
                f"nobody writes the frame `{frame.id}` to `{frame.topic}`",
                frame.at,
                # A model of the robot and a publisher of its state hold most static frames, seldom written here.
                severity=Severity.NOTE if frame.static else None,
                help="name the component in `by`, or write the frame below `frames` of that component",
                element=frame.answering_element,
            )


def misplaced_frame(architecture: Architecture) -> Iterator[Diagnostic]:
    """A frame with a name of REP 105 stands elsewhere than REP 105 says."""
    frames = architecture.frames
    for frame in frames.values():
        upper_name = _find_upper_name(frames, frame.id)
        ancestors = list(islice(walk_ancestors(frames, frame.id), _MAX_DEPTH)) if upper_name else []
        # What stands in an unknown frame, or in a circle, is judged where that is mended.
        top = frames.get([frame.id, *ancestors][-1])
        if upper_name and upper_name not in ancestors and top and top.parent is None:
            yield Diagnostic(
                "misplaced-frame",
                f"`{frame.id}` does not stand below `{upper_name}`, as REP 105 has it",
                frame.parent_at if frame.parent is not None else frame.at,
                labels=(Label(frames[upper_name].at, f"`{upper_name}`"),),
                help=f"make `{upper_name}` its parent, or call it by another name",
                element=frame.answering_element,
            )


def _find_upper_name(frames: Mapping[str, Frame], name: str) -> str | None:
    """Return the frame that REP 105 wants above another: the nearest one that there is, None for any other name."""
    prefix, slash, own_word = name.rpartition("/")
    upper_words = _CHAIN[: _CHAIN.index(own_word)] if own_word in _CHAIN else ()
    own_names = (f"{prefix}{slash}{word}" for word in reversed(upper_words))
    # One map may serve several robots, each with an odometry of its own below it.
    common_names = (word for word in reversed(upper_words) if word in _COMMON_WORDS)
    return next((each for each in (*own_names, *common_names) if each in frames), None)


RULES = (
    (unknown_frame, Severity.ERROR),
    (circular_frames, Severity.ERROR),
    (unpublished_frame, Severity.WARNING),
    (misplaced_frame, Severity.NOTE),
)
