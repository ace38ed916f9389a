"""What generators of code and configuration are made from: plain data, computed for the backends that name it.

The views that several plug-ins and a project's own backends take stand here; the others are brought by plug-ins, which say
in `views` of their facts which function makes each.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import cache, partial

from archgen.diagnostics import Diagnostic
from archgen.installed_plugins import (
    GENERATORS,
    PluginEntry,
    PluginRefusedError,
    list_entries,
    list_shipped_facts,
    load_facts,
    load_object,
    load_shipped_object,
)
from archgen.views.generation.generation_context import GeneratedView, GenerationContext

ViewMaker = Callable[[GenerationContext], GeneratedView]
_FACTS = frozenset({"api", "views"})
_VIEW_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_TEMPLATE_WORDS = frozenset({"options", "item", "key", "path", "href"})
"""What a variable of a template means already."""


def _make_components(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import component_records

    return component_records.make_view(context)


def _make_structure(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import structure_view

    return structure_view.make_view(context)


DOCUMENT_VIEWS = ("outline", "pages", "record", "graphs", "sequences", "tables")
"""The views that documents are made from; a backend may name them, too."""
CORE_VIEWS: Mapping[str, ViewMaker] = {"components": _make_components, "structure": _make_structure}
"""The functions that make the core's own views, by the name that manifests write below `view`."""


def find_view_maker(name: str) -> ViewMaker | None:
    """Return the function that makes a view for generators; None where there is no such view.

    Packages of others are imported for a name that is not among what ships. Raise PluginRefusedError where one is no use.
    """
    if name in DOCUMENT_VIEWS:
        return None
    return CORE_VIEWS.get(name) or _list_shipped_makers().get(name) or _list_foreign_makers().get(name)


def is_shipped_view(name: str) -> bool:
    """Whether a view for generators is archgen's own: in all of them places are as `write_place` returns them."""
    return name in CORE_VIEWS or name in _list_shipped_makers()


def list_view_names(wanted: Collection[str]) -> tuple[str, ...]:
    """Return the names of the core's views; where a wanted one is none of these, of those of plug-ins that ship, too, and where
    one is still missing, of those of others.
    """
    names: tuple[str, ...] = (*DOCUMENT_VIEWS, *CORE_VIEWS)
    for list_makers in (_list_shipped_makers, _list_foreign_makers):
        if not set(wanted) <= set(names):
            names += tuple(list_makers())
    return names


@cache
def _list_shipped_makers() -> Mapping[str, ViewMaker]:
    return {name: partial(_make_shipped_view, target) for _, name, target in list_shipped_facts("views")}


def _make_shipped_view(target: str, context: GenerationContext) -> GeneratedView:
    # Modules are imported for the views that a backend asks for.
    maker: ViewMaker = load_shipped_object(target)
    return maker(context)


def _list_foreign_makers() -> Mapping[str, ViewMaker]:
    makers: dict[str, ViewMaker] = {}
    for entry in list_entries(GENERATORS):
        for name, target in _read_view_targets(entry):
            if name in {*DOCUMENT_VIEWS, *CORE_VIEWS, *_list_shipped_makers(), *makers}:
                _refuse_generator(entry, f"there is a view `{name}` already")
            makers[name] = partial(_make_foreign_view, entry, name, target)
    return makers


def _read_view_targets(entry: PluginEntry) -> Iterator[tuple[str, str]]:
    """Yield the views that a package of others brings: name, and `module:function`."""
    facts = load_facts(entry)
    if unknown := sorted(set(facts) - _FACTS):
        _refuse_generator(entry, f"a generator has no {', '.join(unknown)}")
    for name, target in facts.get("views", {}).items():
        if not _VIEW_NAME.match(name) or name in _TEMPLATE_WORDS:
            _refuse_generator(entry, f"`{name}` cannot be the name of a view")
        yield name, target


def _refuse_generator(entry: PluginEntry, problem: str) -> None:
    raise PluginRefusedError(f"the generator `{entry.name}` of {entry.origin} cannot be used: {problem}")


def _make_foreign_view(entry: PluginEntry, name: str, target: str, context: GenerationContext) -> GeneratedView:
    maker = load_object(entry, target)
    try:
        view = maker(context)
    except Exception as error:  # whatever a stranger's function raises is said in a sentence
        msg = f"the view `{name}` of {entry.origin} fails: {type(error).__name__}: {error}"
        raise PluginRefusedError(msg) from error
    if not isinstance(view, GeneratedView):
        raise PluginRefusedError(f"the view `{name}` of {entry.origin} fails: `{target}` returns no GeneratedView")
    return view


def make_generation_views(
    context: GenerationContext, names: Iterable[str]
) -> tuple[dict[str, object], tuple[Diagnostic, ...]]:
    """Return those of the named views that are for generators, and what they leave out, in the order of its places."""
    makers = {name: maker for name in names if (maker := find_view_maker(name))}
    views = {name: make(context) for name, make in makers.items()}
    findings = dict.fromkeys(finding for view in views.values() for finding in view.findings)
    data: dict[str, object] = {name: view.data for name, view in views.items()}
    return data, tuple(sorted(findings, key=lambda finding: finding.sort_key))
