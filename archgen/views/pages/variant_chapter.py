"""The page and the chapter of variants: what each is for, what it is made of, and what is different in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.variant import Variant
from archgen.views import inline_text
from archgen.views.element_references import link_names
from archgen.views.shapes import (
    Block,
    Bullets,
    Facts,
    Inlines,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
    make_columns,
)

LEAD = "The same project otherwise. Each variant is laid over the project; what it does not name is as everywhere else."


@dataclass(frozen=True, slots=True)
class VariantDifference:
    """What is different in a variant: a sentence for each change, and how many findings hold there, in words."""

    sentences: tuple[str, ...]
    findings: str


def make_variant_table(architecture: Architecture, differences: Mapping[str, VariantDifference]) -> Table | None:
    """List the variants with what each is built on, and how much is different; None where there is none."""
    rows = tuple(
        (
            (Text(each.title, ref=f"variant:{each.id}"), Text(" "), Text(each.id, code=True, muted=True)),
            _link_variants(architecture, each.of),
            _link_words(architecture, each.without or ""),
            inline_text.to_inlines(_count_changes(differences.get(each.id))),
            inline_text.to_inlines(differences[each.id].findings if each.id in differences else ""),
        )
        for each in architecture.variants.values()
    )
    columns = make_columns(("Variant", 1.4), "Built on", ("Without", 1.2), ("Different", 0.8), ("Findings", 1.2))
    return Table("table:variants", "All variants", columns, rows) if rows else None


def make_variant_sections(
    architecture: Architecture, differences: Mapping[str, VariantDifference]
) -> Iterator[Section]:
    """Yield a section for each variant."""
    for variant in architecture.variants.values():
        blocks = tuple(_make_blocks(architecture, variant, differences.get(variant.id)))
        yield Section(f"variant:{variant.id}", variant.title, blocks)


def _make_blocks(architecture: Architecture, variant: Variant, difference: VariantDifference | None) -> Iterator[Block]:
    if variant.description:
        yield Markdown(variant.description)
    facts: list[tuple[str, Inlines]] = [("Id", (Text(variant.id, code=True),))]
    if variant.of:
        facts.append(("Built on", _link_variants(architecture, variant.of)))
    if variant.without:
        facts.append(("Without", _link_words(architecture, variant.without)))
    if variant.drop:
        facts.append(("Drops", inline_text.join_inlines((Text(path, code=True),) for path in variant.drop)))
    facts.append(("Written at", (Text(str(variant.at), code=True),)))
    yield Facts(tuple(facts))
    if difference is None:
        return
    if not difference.sentences:
        yield Paragraph(inline_text.to_inlines("Nothing is different in it."))
        return
    yield Bullets(tuple(link_names(architecture, sentence) for sentence in difference.sentences))


def _link_variants(architecture: Architecture, names: Sequence[str]) -> Inlines:
    return inline_text.join_inlines(
        (Text(name, ref=f"variant:{name}" if name in architecture.variants else None, code=True),) for name in names
    )


def _link_words(architecture: Architecture, selector: str) -> Inlines:
    """Write a selector, with links from the complete ids in it."""
    words = [f"`{word}`" if "`" not in word else word for word in selector.split()]
    return tuple(
        inline
        for at, word in enumerate(words)
        for inline in (*((Text(" "),) if at else ()), *link_names(architecture, word))
    )


def _count_changes(difference: VariantDifference | None) -> str:
    if difference is None:
        return ""
    return inline_text.count_noun(len(difference.sentences), "change") if difference.sentences else "nothing"
