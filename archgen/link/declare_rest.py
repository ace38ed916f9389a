"""Declare all sections but groups, nodes and types: project, partners, requirements, hosts, chains, views and so on."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostic import Severity
from archgen.link import reading, sense
from archgen.link.references import References
from archgen.model.architecture import Chain, Partner, Policy, ProjectInfo, Requirement, UseCase, View, Waypoint
from archgen.model.deployment import Container, Host, Link
from archgen.model.review import Accepted, Review
from archgen.syntax.tree import Table

_WAY = ("node", "component", "output")


def project(root: Table, default_id: str, default_title: str) -> ProjectInfo:
    """Declare the project itself, with defaults for its id and title."""
    below = reading.table(root, "project")
    entry = root.entries.get("project")
    return ProjectInfo(
        id=reading.text(below, "id") or default_id,
        title=reading.text(below, "title") or default_title,
        version=reading.text(below, "version"),
        description=reading.text(below, "description"),
        # Without the section the field keeps its default, which this module would otherwise have to repeat.
        **({"at": entry.at} if entry else {}),
    )


def partners(root: Table) -> dict[str, Partner]:
    """Declare the partners."""
    return {
        name: Partner(
            name,
            reading.title(below, name),
            reading.text(below, "description"),
            reading.text(below, "contact"),
            reading.texts(below, "reviewers"),
            at=entry.at,
        )
        for name, entry, below in reading.elements(root, "partners")
    }


def use_cases(root: Table) -> dict[str, UseCase]:
    """Declare the use cases. One without a title has its id as title: `UC-4` cannot be turned into words."""
    return {
        name: UseCase(name, reading.text(below, "title") or name, reading.text(below, "description"), entry.at)
        for name, entry, below in reading.elements(root, "use_cases")
    }


def requirements(root: Table, references: References) -> dict[str, Requirement]:
    """Declare the requirements, with the use cases that are declared."""
    return {
        name: Requirement(
            id=name,
            title=reading.text(below, "title") or name,
            description=reading.text(below, "description"),
            use_cases=tuple(_known(below, "use_cases", "use case", references, name)),
            tags=reading.texts(below, "tags"),
            urls=reading.words(below, "urls"),
            at=entry.at,
        )
        for name, entry, below in reading.elements(root, "requirements")
    }


def _known(below: Table, key: str, kind: str, references: References, element: str) -> Iterator[str]:
    """Return the plain ids in a list that are declared, each once; the others are reported."""
    named = (references.plain(written, kind, element) for written in reading.scalars(below, key))
    return iter(dict.fromkeys(name for name in named if name))


def hosts(root: Table) -> dict[str, Host]:
    """Declare the hosts."""
    return {
        name: Host(
            id=name,
            title=reading.title(below, name),
            cores=reading.whole(below, "cores"),
            description=reading.text(below, "description"),
            tags=reading.texts(below, "tags"),
            at=entry.at,
        )
        for name, entry, below in reading.elements(root, "hosts")
    }


def containers(root: Table, references: References) -> dict[str, Container]:
    """Declare the containers."""
    return {
        name: Container(
            id=name,
            title=reading.title(below, name),
            host=references.plain(reading.scalar(below, "host"), "host", name),
            threads=reading.whole(below, "threads"),
            at=entry.at,
        )
        for name, entry, below in reading.elements(root, "containers")
    }


def links(root: Table, references: References) -> dict[str, Link]:
    """Declare the links between hosts."""
    found: dict[str, Link] = {}
    for name, entry, below in reading.elements(root, "links"):
        best, worst = sense.latency(reading.table(below, "latency"), name, references.found)
        found[name] = Link(
            id=name,
            title=reading.title(below, name),
            connects=tuple(_known(below, "connects", "host", references, name)),
            bandwidth=sense.positive(below, "bandwidth", "bandwidth", name, references.found),
            best=best,
            worst=worst,
            at=entry.at,
        )
    return found


def chains(root: Table, references: References) -> dict[str, Chain]:
    """Declare the chains; a waypoint that cannot be resolved is kept in `unresolved`: the chain then counts as open."""
    found: dict[str, Chain] = {}
    for name, entry, below in reading.elements(root, "chains"):
        sense.no_entry(below, "through", "element", name, references.found)
        through = [(references.follow(one, _WAY, name), one) for one in reading.scalars(below, "through")]
        found[name] = Chain(
            id=name,
            title=reading.title(below, name),
            through=tuple(Waypoint(e.kind, e.id, one.at) for e, one in through if e),  # type: ignore[arg-type]
            deadline=sense.positive(below, "deadline", "duration", name, references.found),
            requirements=reading.texts(below, "requirements"),
            at=entry.at,
            unresolved=tuple(one.text for e, one in through if e is None),
        )
    return found


def views(root: Table) -> dict[str, View]:
    """Declare the views, except one without `show`, which merging has reported."""
    found: dict[str, View] = {}
    for name, entry, below in reading.elements(root, "views"):
        if below.get("show") is None:
            continue
        level = reading.text(below, "level")
        found[name] = View(
            id=name,
            title=reading.title(below, name),
            show=reading.text(below, "show") or "",
            colour=reading.text(below, "colour"),
            level="implementation" if level == "implementation" else "functional",
            layout=reading.layout(below),
            at=entry.at,
            show_at=reading.place(below, "show"),
        )
    return found


def review(root: Table) -> Review:
    """Declare how changes are judged, without accepted changes that lack a reason, which merging has reported."""
    below = reading.table(root, "review")
    breaking = reading.text(below, "breaking")
    return Review(
        main=reading.text(below, "main"),
        breaking=None if breaking is None else Severity(breaking),
        accepted={
            name: Accepted(name, reading.text(entry, "reason") or "", reading.text(entry, "key"), at.at)
            for name, at, entry in reading.elements(below, "accepted")
            if reading.text(entry, "reason")
        },
        backends=reading.texts(below, "backends"),
    )


def policies(root: Table) -> dict[str, Policy]:
    """Declare the policies, except one without `forbid.from` or `forbid.to`, which merging has reported."""
    found: dict[str, Policy] = {}
    for name, entry, below in reading.elements(root, "policies"):
        forbid = reading.table(below, "forbid")
        if forbid.get("from") is not None and forbid.get("to") is not None:
            found[name] = Policy(
                id=name,
                title=reading.title(below, name),
                forbid_from=reading.text(forbid, "from") or "",
                forbid_to=reading.text(forbid, "to") or "",
                at=entry.at,
                from_at=reading.place(forbid, "from"),
                to_at=reading.place(forbid, "to"),
            )
    return found
