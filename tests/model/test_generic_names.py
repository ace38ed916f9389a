"""Names of generic types are read and written, and any other name stays as it is."""

from __future__ import annotations

import pytest

from archgen.model.generic_names import read_generic_name, write_generic_name


@pytest.mark.parametrize(
    ("name", "base", "arguments", "written"),
    [
        ("Envelope< Pose,Twist >", "Envelope", ("Pose", "Twist"), "Envelope<Pose, Twist>"),
        ("A<B<C>, string<=10>", "A", ("B<C>", "string<=10"), "A<B<C>, string<=10>"),
        ("a < b", "a < b", (), "a < b"),
        ("A<>", "A<>", (), "A<>"),
        ("A<B>>", "A<B>>", (), "A<B>>"),
        ("A<B><C>", "A<B><C>", (), "A<B><C>"),
        ("A<B>[]", "A<B>[]", (), "A<B>[]"),
        ("<A>", "<A>", (), "<A>"),
        ("A<" * 300 + ">" * 300, "A<" * 300 + ">" * 300, (), "A<" * 300 + ">" * 300),
    ],
)
def test_names_of_generic_types(name: str, base: str, arguments: tuple[str, ...], written: str) -> None:
    assert read_generic_name(name) == (base, arguments)
    assert write_generic_name(name) == written
