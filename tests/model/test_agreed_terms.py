"""Agreements of two partners: found in either order, told apart by digits."""

from __future__ import annotations

from archgen.language.language_tables import KEYS
from archgen.model.agreed_terms import GENERAL_TERMS, INTERFACE_TERMS, Agreement, Signature, find_agreement


def test_the_words_are_those_of_the_language() -> None:
    assert set(KEYS["interface_terms"]) == set(INTERFACE_TERMS)
    assert set(KEYS["agreed_terms"]) == {*INTERFACE_TERMS, *GENERAL_TERMS}


def test_an_agreement_is_found_in_either_order() -> None:
    agreements = {"b-a": Agreement("b-a", {"late": "stop"})}
    assert find_agreement(agreements, "a", "b") is agreements["b-a"]
    assert find_agreement(agreements, "a", "c") == Agreement("a-c")


def test_both_have_to_sign() -> None:
    signed = Signature(by={"a": "Ada"})
    assert Agreement("a-b", signed=signed).binding_signature is None
    assert Agreement("a-b", signed=Signature(by={"a": "Ada", "b": "Ben"})).binding_signature is not None


def test_line_breaks_are_no_other_words() -> None:
    digits = Agreement("a-b", {"late": "it stops"}).hash_terms()
    assert digits == Agreement("a-b", {"late": "it\n  stops"}).hash_terms()
    assert digits != Agreement("a-b", {"late": "it goes on"}).hash_terms()
    assert digits != Agreement("a-b", interfaces={"x": {"late": "it stops"}}).hash_terms()
