"""The picture of changed components and their connections."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from archgen.compare import Comparison
from archgen.views.changes.telling import SIGNS
from archgen.views.graphs import boxes
from archgen.views.graphs.changes.budget import Budget
from archgen.views.graphs.changes.folded import folded
from archgen.views.graphs.changes.lines import Line, arrows
from archgen.views.graphs.changes.merged import Edge, Happened, edges, flows_changed, happened
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index, index
from archgen.views.shapes import Box, Changed, Cluster, Graph
from archgen.views.words import plural

NAME = "changes/components"
_NAMED = 12


@dataclass(frozen=True, slots=True)
class _Both:
    """The two versions, laid over each other."""

    found: Comparison
    before: Index
    after: Index
    told: Happened
    lines: Sequence[Line]

    @property
    def subjects(self) -> frozenset[str]:
        """Return the components that changed themselves."""
        return frozenset(self.told.components)

    def group(self, name: str) -> str:
        """Return the group of a component, by common ids."""
        item = self.after.architecture.components.get(name)
        return item.group if item else self.found.names.to("group", name.partition(".")[0])


def functional(found: Comparison, budget: Budget) -> Graph | None:
    """Draw what changed and its surroundings; None if no component and no connection changed."""
    before, after = found.before.architecture, found.after.architecture
    told = happened(found)
    both = _Both(found, index(before), index(after, found.new), told, tuple(_lines(found, told)))
    ends = {end for line in both.lines if line.change for end in line.ends}
    core = {name for name in both.subjects | ends if _exists(both, name)}
    if not core:
        return None
    near = {end for line in both.lines if not core.isdisjoint(line.ends) for end in line.ends} - core
    beside = {end for line in both.lines if not both.subjects.isdisjoint(line.ends) for end in line.ends} - core
    # `neighbours` includes those behind a changed connection only; they are counted, but never drawn.
    shown = core | beside if len(core | beside) <= budget.around else core
    drawn = [
        line for line in both.lines if shown.issuperset(line.ends) and (line.change or _at(line, both, shown, core))
    ]
    left = len(near - shown)
    notes = (f"{plural(left, 'unchanged neighbour')} not drawn.",) if left else ()
    graph = Graph(
        NAME,
        "What changed: components and connections",
        "framed",
        tuple(_boxes(both, shown)),
        arrows(drawn),
        tuple(_frames(both, shown)),
        direction=after.layout.direction or "left-right",
        notes=notes,
        alt=_alt(both),
    )
    graph = folded(graph, budget)
    return with_legend(replace(graph, asked=sum(arrow.count for arrow in graph.arrows)))


def _at(line: Line, both: _Both, shown: set[str], core: set[str]) -> bool:
    """Whether an unchanged connection is worth its line: it touches a changed component, or joins two drawn anyway."""
    return (
        not both.subjects.isdisjoint(line.ends)
        or (shown == core and core.issuperset(line.ends))
        or len(shown) <= len(core)
    )


def _exists(both: _Both, name: str) -> bool:
    return name in both.after.architecture.components or _old(both, name) is not None


def _old(both: _Both, name: str) -> str | None:
    """Return the old id of a component, None if it is new."""
    was = both.found.names.back.get("component", {}).get(name, name)
    return was if was in both.before.architecture.components else None


def _lines(found: Comparison, told: Happened) -> Iterator[Line]:
    """Yield all connections of both versions with their change, except those that may not have been read."""
    old = edges(found.before.architecture, found.names)
    new = edges(found.after.architecture, type(found.names)())
    unknown = found.told.unknown
    for key in (*new, *(key for key in old if key not in new)):
        edge = new.get(key) or old[key]
        if key in new and key in old:
            said = tuple(flows_changed(found.after.architecture, edge, told))
            yield _line(edge, "changed" if said else None, said)
        # In a part that could not be read: not known to be removed or added.
        elif unknown(("output", edge.output)) or unknown(("input", edge.input)):
            yield from [_line(edge, None, ())] if key in new else []
        elif edge.input in told.said or not told.components.keys().isdisjoint((edge.tail, edge.head)):
            yield _line(edge, "added" if key in new else "removed", tuple(told.said.get(edge.input, ())))


def _line(edge: Edge, change: Changed | None, said: tuple[str, ...]) -> Line:
    plain = f"{edge.output} → {edge.input}" + (f" ({edge.label})" if edge.label else "")
    sentence = "\n".join((f"{SIGNS[change]} {plain}" if change else plain, *said))
    return Line(edge.tail, edge.head, edge.style, edge.label, change, sentence, optional=edge.optional)


def _boxes(both: _Both, shown: set[str]) -> Iterator[Box]:
    """Yield the components in the order of the second version, removed ones at the end of their group."""
    places = {name: at for at, name in enumerate(both.after.architecture.components)}
    groups = {name: at for at, name in enumerate(both.after.architecture.groups)}
    last = len(places)
    for name in sorted(shown, key=lambda name: (groups.get(both.group(name), last), places.get(name, last), name)):
        yield _box(both, name)


def _box(both: _Both, name: str) -> Box:
    change = both.told.components.get(name)
    item = both.after.architecture.components.get(name)
    drawn = boxes.component(both.after, item) if item else _gone(both, name)
    group = both.group(name)
    common = replace(drawn, id=name, style="component", colour=None, cluster=group, ref=f"changes:{group}")
    if change is None:
        return replace(common, emphasis="neighbour", badge=None)
    said = (*both.told.said.get(name, ()), drawn.tooltip)
    return replace(common, title=f"{SIGNS[change]} {drawn.title}", change=change, tooltip="\n".join(said))


def _gone(both: _Both, name: str) -> Box:
    return replace(
        boxes.component(both.before, both.before.architecture.components[_old(both, name) or name]), badge=None
    )


def _frames(both: _Both, shown: set[str]) -> Iterator[Cluster]:
    kinds = {(each.sort, each.element): each.kind for each in both.found.changes if each.sort == "group"}
    known = {**both.before.architecture.groups, **both.after.architecture.groups}
    for name in dict.fromkeys(box.cluster for box in _boxes(both, shown) if box.cluster):
        title = known[name].title if name in known else name
        kind = kinds.get(("group", name))
        sign = f"{SIGNS[kind]} " if kind and kind != "changed" else ""
        yield Cluster(name, f"{sign}{title}", emphasis="neighbour", ref=f"changes:{name}", tooltip=title)


def _alt(both: _Both) -> str:
    titles = {name: _box(both, name).title for name in sorted(both.subjects) if _exists(both, name)}
    by_kind: Mapping[str, list[str]] = {
        # Without the sign and the blank that `_draw_box` puts before the title.
        kind: [titles[name][2:] for name in titles if both.told.components[name] == kind]
        for kind in ("added", "removed", "changed", "renamed")
    }
    said = [
        f"{kind}: {', '.join(names[:_NAMED])}{', ...' if len(names) > _NAMED else ''}"
        for kind, names in by_kind.items()
        if names
    ]
    counts = {kind: sum(line.change == kind for line in both.lines) for kind in ("added", "removed", "changed")}
    said += [f"{plural(count, 'connection')} {kind}" for kind, count in counts.items() if count]
    return "; ".join(said) + "."
