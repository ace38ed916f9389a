"""In which order variants are laid over the project: what one is built on comes first, each once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.diagnostics import Diagnostic, Label, did_you_mean, join_words
from archgen.link import mapping_values
from archgen.link.declare.section_declaration import declare_variants
from archgen.model.variant import BASE_NAME, Variant
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

_MAX_STEPS = 150
"""So many layers all variants may have together: each may cost as much as a project of its own, and a stranger's file may
have thousands. Fifty variants, each built on two others, have as many."""


def list_judged(variants: Mapping[str, Variant]) -> tuple[str, ...]:
    """Return the variants that are judged: the first ones, up to a limit on what they are built on."""
    judged: list[str] = []
    step_count = 0
    for name in variants:
        step_count += len(list_steps(variants, [name]))
        if step_count > _MAX_STEPS:
            break
        judged.append(name)
    return tuple(judged)


def list_steps(variants: Mapping[str, Variant], names: Sequence[str]) -> tuple[str, ...]:
    """Return the variants that are laid over the project, one after the other, for it to stand in some of them.

    Each stands behind those that it is built on, and once. Circles are cut, and unknown names left out: both are
    reported where they are written.
    """
    steps: dict[str, None] = {}
    open_names: set[str] = set()
    # Without recursion: a stranger's file may build ten thousand variants on one another.
    pending: list[tuple[str, bool]] = [(name, False) for name in reversed(names)]
    while pending:
        name, is_left = pending.pop()
        if is_left:
            open_names.discard(name)
            steps[name] = None
        elif name in variants and name not in steps and name not in open_names:
            open_names.add(name)
            pending.append((name, True))
            pending += [(each, False) for each in reversed(variants[name].of)]
    return tuple(steps)


def check_variant_order(root: MappingNode, lost_keys: frozenset[str]) -> Iterator[Diagnostic]:
    """Report variants that are built on what is no variant, and those that are built on themselves."""
    references = {
        name: mapping_values.get_scalars(body, "of")
        for name, _, body in mapping_values.iterate_elements(root, "variants")
    }
    variants = declare_variants(root)
    judged = list_judged(variants)
    if len(judged) < len(variants):
        name = list(variants)[len(judged)]
        yield Diagnostic(
            "too-large",
            f"all variants together have more than {_MAX_STEPS} layers: of {len(variants):,} only the first {len(judged)} are judged",
            variants[name].at,
            help="build fewer variants on one another; values alone may stand in a parameter file",
            element=name,
        )
    for name, scalars in references.items():
        for scalar in scalars:
            if scalar.text not in references and scalar.text not in lost_keys:
                yield _diagnose_unknown(scalar, name, [each for each in references if each != name])
    yield from (_diagnose_circle(references, circle) for circle in _find_circles(references))


def _diagnose_unknown(scalar: ScalarNode, name: str, known_names: Sequence[str]) -> Diagnostic:
    help_line = did_you_mean(scalar.text, known_names) or "`of` names variants of this project"
    if scalar.text == BASE_NAME:
        help_line = "every variant is built on the project itself: leave it out"
    return Diagnostic("unknown-variant", f"no variant named `{scalar.text}`", scalar.span, help=help_line, element=name)


def _find_circles(references: Mapping[str, Sequence[ScalarNode]]) -> Iterator[list[str]]:
    """Yield ways from variants back to themselves through what they are built on; each variant is on one of them at most."""
    finished: set[str] = set()
    for first in references:
        # The way from the first variant to the one that is looked at, each with what it is built on and was not asked.
        way: dict[str, Iterator[ScalarNode]] = {} if first in finished else {first: iter(references[first])}
        while way:
            name = next(reversed(way))
            base = next((scalar.text for scalar in way[name] if scalar.text in references), None)
            if base is None:
                finished.add(name)
                del way[name]
            elif base in way:
                names = list(way)
                circle = names[names.index(base) :]
                yield circle
                finished.update(circle)
                for each in circle:
                    del way[each]
            elif base not in finished:
                way[base] = iter(references[base])


def _diagnose_circle(references: Mapping[str, Sequence[ScalarNode]], circle: list[str]) -> Diagnostic:
    places = [
        next(scalar for scalar in references[name] if scalar.text == following)
        for name, following in zip(circle, [*circle[1:], circle[0]], strict=True)
    ]
    shown_names = [f"`{name}`" for name in circle[:8]]
    message = (
        f"the variant `{circle[0]}` is built on itself"
        if len(circle) == 1
        else f"the variants {join_words([*shown_names, *(['others'] if len(circle) > len(shown_names) else [])], 'and')} are built on one another"
    )
    return Diagnostic(
        "circular-variant",
        message,
        places[0].span,
        labels=tuple(
            Label(scalar.span, f"`{name}` is built on it")
            for name, scalar in list(zip(circle, places, strict=True))[1:8]
        ),
        help="take one of them out of `of`",
        element=circle[0],
    )
