"""Draw the coordinate frames as a tree: what each is placed in, and who writes it."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.coordinate_frames import Frame, index_child_frames
from archgen.views.elements.frame_users import name_writer
from archgen.views.graphs import element_boxes
from archgen.views.graphs.graph_folding import MAX_BOXES, add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Graph


def draw_frames(lookup: Lookup) -> Graph:
    """Draw the frames, roots first; what is too far down for a picture is counted in a note."""
    frames = lookup.architecture.frames
    drawn_names = _order_names(frames.values())[:MAX_BOXES]
    # A parent that nobody declares is drawn, too: what is placed in it would else look like a root.
    boxes = [_frame_box(lookup, frames[name]) if name in frames else _unknown_box(name) for name in drawn_names]
    arrows = [
        Arrow(f"frame {name}", f"frame {frame.parent}", f"frame {name}", _label_arrow(frame), ref=f"frame:{name}")
        for name in drawn_names
        if (frame := frames.get(name)) and frame.parent in drawn_names
    ]
    hidden = len(frames) - sum(name in frames for name in drawn_names)
    roots = [name for name in drawn_names if name not in frames or frames[name].parent is None]
    graph = Graph(
        "frames",
        f"{lookup.architecture.project.title}: frames",
        "flow",
        tuple(boxes),
        tuple(arrows),
        direction=lookup.architecture.layout.direction or "top-bottom",
        notes=(f"{count_noun(hidden, 'frame')} further down not drawn: the table has all of them.",) if hidden else (),
        alt=f"{count_noun(len(frames), 'frame')} below {', '.join(roots) or 'no root'}.",
        asked=len(arrows),
        kind="frames",
    )
    return add_legend_keys(graph)


def _order_names(frames: Iterable[Frame]) -> list[str]:
    """Return the names of all frames and parents, level by level from the roots on; circles, without a root, at last."""
    frames_by_name = {frame.id: frame for frame in frames}
    children = index_child_frames(frames_by_name)
    names = [name for name in children if name not in frames_by_name]
    names += [frame.id for frame in frames_by_name.values() if frame.parent is None]
    # The list grows while it is read: each name adds those below it.
    for name in names:
        names += [child.id for child in children.get(name, ())]
    return list(dict.fromkeys([*names, *frames_by_name]))


def _frame_box(lookup: Lookup, frame: Frame) -> Box:
    component = lookup.architecture.components.get(frame.by or "") if frame.by_kind == "component" else None
    title_lines = (frame.title,) if frame.title != frame.id else ()
    writer_lines = (f"by {name_writer(lookup.architecture, frame)}",) if frame.parent is not None else ()
    # By place: a node may have the frame's name, and findings of its own.
    places = {frame.at, frame.parent_at}
    severities = [finding.effective_severity for finding in lookup.findings if finding.span in places]
    return Box(
        f"frame {frame.id}",
        frame.id,
        (*title_lines, *writer_lines),
        colour=element_boxes.group_hue(lookup, component.group) if component else None,
        ref=f"frame:{frame.id}",
        tooltip="\n".join([frame.id, *title_lines, *writer_lines]),
        badge=element_boxes.name_severity(severities),
    )


def _unknown_box(name: str) -> Box:
    return Box(f"frame {name}", name, ("not declared",), style="external", tooltip=f"No frame named {name}")


def _label_arrow(frame: Frame) -> str:
    return "static" if frame.static else frame.rate.text if frame.rate else ""
