"""Data types, enumerations and classes that are only data: the types of the language, with fields where all are known.

Templates of UML: a class with names that stand for types is a generic component type, a bound class is made from it.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from decimal import Decimal, InvalidOperation

from archgen.plugin.importing import XmlElement, make_id
from archgen.plugin.model import read_generic_name
from archgen.plugin.ros import spell_message_name
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, ImportLedger, make_hints, name_conceptual_type, name_element
from archgen.plugins.xmi.uml_catalogue import UmlCatalogue, read_description
from archgen.plugins.xmi.uml_index import Reference, UmlIndex, get_id, get_kind, get_name, list_child_elements

_PARAMETER_TYPES = {
    **dict.fromkeys(("boolean", "bool", "eboolean"), "boolean"),
    **dict.fromkeys(("string", "std::string", "char*", "qstring", "estring", "text"), "string"),
    **dict.fromkeys(("real", "float", "double", "float32", "float64", "efloat", "edouble", "long double"), "float"),
    **dict.fromkeys(("integer", "int", "long", "short", "unlimitednatural", "natural", "unsigned", "eint"), "integer"),
    **dict.fromkeys((f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)), "integer"),
    **dict.fromkeys((f"{sign}int{bits}_t" for sign in ("", "u") for bits in (8, 16, 32, 64)), "integer"),
    **dict.fromkeys(("unsigned int", "unsigned long", "long long", "size_t", "byte", "elong"), "integer"),
}
"""The type of a parameter, by what tools call it in small letters."""
_FIELD_TYPES = {"boolean": "bool", "string": "string", "float": "float64", "integer": "int64"}
_EXACT_FIELD_TYPES = frozenset(
    {
        "bool",
        "char",
        "float32",
        "float64",
        "wstring",
        *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
    }
)
_NARROW_FIELD_TYPES = {"float": "float32", "int": "int32", "short": "int16", "byte": "uint8"}
_BOUNDED_TEXT = re.compile(r"w?string<=[0-9]{1,9}\Z")
_NOTHING = frozenset({"void", "none", "nothing", ""})
_UNIT = re.compile(r"([0-9]+(?:\.[0-9]+)?)\s*(ns|us|ms|s|min|h|Hz|kHz)\Z")
_MAX_DIGITS = 15


def find_type_name(index: UmlIndex, element: XmlElement) -> str:
    """Return the name of the type of a property, port or parameter; empty where it says none."""
    reference = index.find_reference(element, "type")
    name = name_referenced(reference) if reference else ""
    return "" if name.lower() in _NOTHING else name


def name_referenced(reference: Reference) -> str:
    """Return the name of a type that something refers to, as the language writes it."""
    is_own = reference.element is not None and get_id(reference.element).startswith(OWN_PREFIX)
    # What archgen wrote is a name of the language: its brackets are generics.
    return reference.name if is_own else name_conceptual_type(reference.name)


def find_parameter_type(type_name: str) -> str | None:
    """Return what a parameter of a type of UML is in the language; None for what is no primitive type."""
    return _PARAMETER_TYPES.get(type_name.removeprefix("const ").removesuffix("&").strip().lower())


def find_field_type(type_name: str) -> str | None:
    """Return the type of a message's field for a primitive type of UML; None for what is none."""
    if type_name in _EXACT_FIELD_TYPES or _BOUNDED_TEXT.match(type_name):
        return type_name
    kind = find_parameter_type(type_name)
    return _NARROW_FIELD_TYPES.get(type_name.lower()) or _FIELD_TYPES.get(kind or "")


def is_many(element: XmlElement) -> bool:
    """Whether a property has more than one value."""
    return write_array(element) != ""


def write_array(element: XmlElement) -> str:
    """Return the brackets of an array for the multiplicity of a property: `[]`, `[3]`, `[<=5]`; empty for one value."""
    lower, upper = _read_bound(element, "lower"), _read_bound(element, "upper")
    if upper in {"*", "-1"}:
        return "[]"
    is_number = upper.isascii() and upper.isdigit() and len(upper) <= _MAX_DIGITS
    if not is_number or int(upper) < 2:  # noqa: PLR2004 - one is no array
        return ""
    return f"[{int(upper)}]" if lower == upper else f"[<={int(upper)}]"


def _read_bound(element: XmlElement, side: str) -> str:
    bound = element.find(f"{side}Value")
    # UML2 leaves out the value of a bound that is 0.
    written = bound.attributes.get("value", "0") if bound is not None else element.attributes.get(side, "1")
    return written.strip()


def read_default(index: UmlIndex, element: XmlElement) -> str | None:
    """Return the default of a property as text; None where it has none.

    A literal without a value has that of its kind: tools leave out `0`, `0.0` and `false`.
    """
    default = element.find("defaultValue")
    if default is None:
        return element.attributes.get("default")
    kind = get_kind(default)
    if kind == "InstanceValue":
        instance = index.find_reference(default, "instance")
        return (instance.name if instance else "") or None
    value = default.attributes.get("value") or default.attributes.get("body")
    if value is None:
        child = default.find("value") or default.find("body")
        value = child.text.strip() if child is not None else None
    absent = {"LiteralInteger": "0", "LiteralUnlimitedNatural": "0", "LiteralReal": "0.0", "LiteralBoolean": "false"}
    return absent.get(kind) if value is None else value


def convert_value(text: str, kind: str) -> object:
    """Return a default as a value of a parameter's type. Raise ValueError where it is none."""
    words = text.strip()
    if kind == "boolean":
        if words.lower() not in {"true", "false"}:
            raise ValueError(words)
        return words.lower() == "true"
    if kind == "string":
        has_quotes = len(words) > 1 and words[0] == words[-1] and words[0] in "\"'"
        return words[1:-1] if has_quotes else text
    if len(words) > _MAX_DIGITS + 10 or "_" in words or not words.isascii():
        # Python reads more than the tools write: `1_000`, digits of other scripts.
        raise ValueError(words)
    if kind == "integer":
        return int(words, 0) if words.lower().startswith("0x") else int(words)
    value = float(words.removesuffix("f"))
    if value - value != 0:
        raise ValueError(words)
    return value


def read_period(text: str) -> dict[str, object] | None:
    """Return `timing` for the default of a property `sample`: a number is in seconds, 0 is not periodic.

    None where the text is no period.
    """
    words = text.strip().strip("\"'")
    if found := _UNIT.match(words):
        key = "rate" if found[2].endswith("Hz") else "period"
        return {key: f"{found[1]} {found[2]}"} if Decimal(found[1]) else {}
    try:
        seconds = Decimal(words)
    except InvalidOperation:
        return None
    if not seconds.is_finite() or seconds < 0 or seconds > _LONGEST or seconds * 1_000_000_000 % 1:
        return None
    return {"period": _write_whole_duration(seconds)} if seconds else {}


def _write_whole_duration(seconds: Decimal) -> str:
    """Return a duration with the greatest unit in which it is whole, else in ns: `20 ms`."""
    for factor, unit in ((1, "s"), (1_000, "ms"), (1_000_000, "us")):
        if (amount := seconds * factor) == amount.to_integral_value():
            return f"{int(amount)} {unit}"
    return f"{int(seconds * 1_000_000_000)} ns"


_LONGEST = Decimal(86_400 * 365)


SIGNATURE_KINDS = ("TemplateSignature", "RedefinableTemplateSignature")
_PARAMETER_KINDS = ("ClassifierTemplateParameter", "TemplateParameter", "Parameter")
_BOUND_PREFIX = f"{OWN_PREFIX}bound."
_GENERIC_NAME = re.compile(r"[A-Z][A-Za-z0-9]{0,63}\Z")
"""As the language has it. Numbers that C++ hands to a template have other names, and are no types."""
TypeArguments = tuple[str, ...]
"""What the generic names of a template stand for, in their order; none where it is no template."""


def read_generic_names(index: UmlIndex, signature: XmlElement) -> tuple[str, ...]:
    """Return the names of a template that stand for types; none where some are no names of types, or two the same."""
    formals = list_child_elements(signature, *_PARAMETER_KINDS)
    references = [index.find_reference(each, "parameteredElement", "ownedParameteredElement") for each in formals]
    names = tuple(each.name if each else "" for each in references)
    is_usable = all(_GENERIC_NAME.match(name) for name in names) and len(set(names)) == len(names)
    return names if is_usable else ()


class TemplateClasses:
    """The classes that are templates, with their generic names, and the classes that are bound to them."""

    def __init__(self, ledger: ImportLedger, catalogue: UmlCatalogue) -> None:
        self._index, self._ledger = ledger.index, ledger
        self.generic_names: dict[XmlElement, tuple[str, ...]] = {}
        self._formals: dict[XmlElement, list[XmlElement]] = {}
        self._signatures: dict[XmlElement, XmlElement] = {}
        for element in catalogue.classes:
            for signature in list_child_elements(element, *SIGNATURE_KINDS):
                self._read_signature(element, signature)
        self.bindings: dict[XmlElement, tuple[XmlElement, TypeArguments]] = {}
        for element in catalogue.classes:
            for binding in list_child_elements(element, "TemplateBinding"):
                self._read_binding(element, binding)
        self.classes = [each for each in catalogue.classes if not self._is_name_only(each)]
        """All classes, without those by which archgen writes `filter<Pose>`."""

    def _is_name_only(self, element: XmlElement) -> bool:
        return element in self.bindings and get_id(element).startswith(_BOUND_PREFIX)

    def _read_signature(self, owner: XmlElement, signature: XmlElement) -> None:
        names = read_generic_names(self._index, signature)
        if not names or owner in self.generic_names:
            words = f"{name_element(owner)} is no generic component type: its template's parameters need a name each, as `T`"
            self._ledger.leave(signature, words)
            return
        self.generic_names[owner] = names
        self._formals[owner] = list_child_elements(signature, *_PARAMETER_KINDS)
        self._signatures[signature] = owner
        self._ledger.take(signature)

    def _read_binding(self, owner: XmlElement, binding: XmlElement) -> None:
        signature = self._index.find_reference(binding, "signature")
        template = self._signatures.get(signature.element) if signature and signature.element else None
        if template is None or owner in self.bindings or template is owner:
            words = f"{name_element(owner)} is not bound to a template: a component type is made from one class of these files"
            self._ledger.leave(binding, words)
            return
        actuals: dict[XmlElement, str] = {}
        for substitution in list_child_elements(binding, "TemplateParameterSubstitution"):
            formal = self._index.find_reference(substitution, "formal")
            actual = self._index.find_reference(substitution, "actual", "ownedActual")
            if formal and formal.element and actual:
                name = name_referenced(actual)
                actuals[formal.element] = find_field_type(name) or name
        arguments = tuple(actuals.get(each, "") for each in self._formals[template])
        if not all(arguments):
            names = ", ".join(f"`{name}`" for name in self.generic_names[template])
            words = f"{name_element(owner)} is not bound to `{get_name(template)[:80]}`: it does not say what {names} stands for"
            self._ledger.leave(binding, words)
            return
        self.bindings[owner] = template, arguments
        self._ledger.take(binding)

    def resolve(self, element: XmlElement) -> tuple[XmlElement, TypeArguments]:
        """Return the class that an element stands for, with what its generic names stand for."""
        return self.bindings[element] if self._is_name_only(element) else (element, ())

    def describe_unbound(self, element: XmlElement) -> str:
        """Return why nothing can be made from what an element stands for; empty where something can."""
        template, arguments = self.resolve(element)
        names = self.generic_names.get(template, ())
        if not names or arguments:
            return ""
        return f"nothing says what {', '.join(f'`{name}`' for name in names)} of `{get_name(template)[:80]}` stands for"


_UNDECLARED = (f"{OWN_PREFIX}name.", f"{OWN_PREFIX}choices.")
"""Ids of types that archgen wrote because something names them: nobody declares them."""
_MESSAGE = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*(?:/msg)?/[A-Z][A-Za-z0-9_]*\Z")


class UmlDataTypes:
    """Makes the section `types`. Nothing else than the file says: a type with a field of unknown type has no fields."""

    def __init__(self, ledger: ImportLedger, elements: Iterable[XmlElement]) -> None:
        self._index, self._ledger = ledger.index, ledger
        self._elements: dict[str, XmlElement] = {}
        self._generic_names: dict[str, tuple[str, ...]] = {}
        for element in elements:
            name = name_referenced(Reference(element, get_name(element)))
            if find_field_type(name) or get_id(element).startswith(_UNDECLARED):
                # It is a type of the language itself.
                ledger.take(element)
                continue
            if not name or name in self._elements:
                why = "there is another one of this name" if name else "it has no name"
                ledger.refuse(element, why)
                continue
            self._elements[name] = element
            for signature in list_child_elements(element, *SIGNATURE_KINDS):
                self._read_signature(name, signature)
        self._valueless: set[str] = set()
        self._fields = {name: self._read_fields(name, each) for name, each in self._elements.items()}
        self._drop_nameless_fields()
        self._drop_unknown_fields()

    def _read_signature(self, name: str, signature: XmlElement) -> None:
        names = read_generic_names(self._index, signature)
        if names and name not in self._generic_names:
            self._generic_names[name] = names
            self._ledger.take(signature)
        else:
            words = f"`{name[:80]}` is no generic type: its template's parameters need a name each, as `T`"
            self._ledger.leave(signature, words)

    def _read_fields(self, type_name: str, element: XmlElement) -> dict[str, dict[str, object]] | None:
        """Return the fields of a type; None where it has none, or one whose type is not known."""
        fields: dict[str, dict[str, object]] = {}
        children = list_child_elements(element, "Property")
        for child in children:
            name = make_id(get_name(child), "field") if get_name(child) else ""
            written = find_type_name(self._index, child)
            primitive = find_field_type(written)
            known = primitive or written
            is_known = primitive is not None or self._is_known(type_name, known) or _MESSAGE.match(known) is not None
            problem = "it has no name" if not name else "there is another one" if name in fields else ""
            if problem or not is_known:
                why = problem or "its type is not known"
                others = [each for each in children if each is not child]
                words = f"the fields of `{get_name(element)[:80]}` are not taken: of `{get_name(child)[:80]}` {why}"
                self._ledger.leave(child, words, others=others)
                return None
            fields[name] = {"type": known + write_array(child)} | self._read_comment(child)
        return fields or None

    def _is_known(self, type_name: str, written: str) -> bool:
        """Whether a type of a field is one of these files, a generic name of the type, or bound: `Envelope<Pose>`."""
        base, arguments = read_generic_name(written)
        if len(arguments) != len(self._generic_names.get(base, ())):
            return False
        if arguments:
            return all(self._is_known(type_name, each) or find_field_type(each) is not None for each in arguments)
        return written in self._elements or written in self._generic_names.get(type_name, ())

    def _drop_nameless_fields(self) -> None:
        """Leave out fields and values of types after which no message can be called, or whose message another one has."""
        first_types: dict[str, str] = {}
        for name, element in self._elements.items():
            literals = list_child_elements(element, "EnumerationLiteral") if _is_enumeration(element) else []
            if not self._fields[name] and not literals:
                continue
            message = spell_message_name(name, {})
            reason = "no message of ROS can be called so, which needs letters and digits, a letter first"
            if message is not None:
                first = first_types.setdefault(message, name)
                reason = f"its message would be `{message}`, as that of `{first[:80]}`" if first != name else ""
            if reason and literals:
                self._valueless.add(name)
                words = f"the values of `{name[:80]}` are not taken: {reason}"
                self._ledger.leave(literals[0], words, others=literals[1:])
            elif reason:
                self._drop_fields(name, reason)

    def _drop_unknown_fields(self) -> None:
        """Leave out fields of types that have none themselves, and of those that hold themselves."""
        inner_types = {name: self._list_inner_types(fields or {}) for name, fields in self._fields.items()}
        users: dict[str, list[str]] = defaultdict(list)
        for name, inner in inner_types.items():
            for each in inner:
                users[each].append(name)
        unknown = [
            name for name, element in self._elements.items() if not self._fields[name] and not _is_enumeration(element)
        ]
        while unknown:
            for user in users[unknown.pop()]:
                if self._fields[user]:
                    self._drop_fields(user, "the fields of one of their types are not known")
                    unknown.append(user)
        for name in self._list_unwhole(inner_types, users):
            self._drop_fields(name, "it would hold itself, or a type that does")

    def _list_unwhole(self, inner_types: Mapping[str, Collection[str]], users: Mapping[str, list[str]]) -> list[str]:
        """Return the types with fields that are not reached from those that hold no others."""
        open_counts = {name: len(inner_types[name]) for name, fields in self._fields.items() if fields}
        whole = [name for name, count in open_counts.items() if not count]
        while whole:
            for user in users.get(whole.pop(), ()):
                if user in open_counts:
                    open_counts[user] -= 1
                    if not open_counts[user]:
                        whole.append(user)
        return [name for name, count in open_counts.items() if count]

    def _list_inner_types(self, fields: Mapping[str, Mapping[str, object]]) -> dict[str, None]:
        """Return the types of these files that fields have, without enumerations: these are whole in themselves."""
        names = dict.fromkeys(str(field["type"]).partition("[")[0] for field in fields.values())
        return {name: None for name in names if name in self._elements and not _is_enumeration(self._elements[name])}

    def _drop_fields(self, name: str, reason: str) -> None:
        self._fields[name] = None
        element = self._elements[name]
        properties = list_child_elements(element, "Property")
        self._ledger.leave(properties[0], f"the fields of `{name[:80]}` are not taken: {reason}", others=properties[1:])

    def make_types(self) -> dict[str, object]:
        """Return the section `types`."""
        section: dict[str, object] = {}
        for name, element in self._elements.items():
            body: dict[str, object] = {}
            if name in self._generic_names:
                body["generic"] = list(self._generic_names[name])
            if _is_enumeration(element) and name not in self._valueless:
                body |= self._write_values(element)
            elif fields := self._fields[name]:
                for child in list_child_elements(element, "Property"):
                    self._ledger.take(child)
                body["fields"] = {key: each if len(each) > 1 else each["type"] for key, each in fields.items()}
            section[name] = body | self._read_comment(element) | make_hints(element)
            self._ledger.take(element)
        return section

    def _read_comment(self, element: XmlElement) -> dict[str, object]:
        texts = read_description(self._ledger, element)
        comment = texts.get("comment") or texts.get("description")
        return {"comment": comment} if comment else {}

    def _write_values(self, element: XmlElement) -> dict[str, object]:
        values = [
            make_id(get_name(each), "value").upper() for each in list_child_elements(element, "EnumerationLiteral")
        ]
        if len(set(values)) != len(values):
            self._ledger.leave(element, f"the values of `{get_name(element)[:80]}` are not taken: two have one name")
            return {}
        return {"values": values} if values else {}


def _is_enumeration(element: XmlElement) -> bool:
    return get_kind(element) == "Enumeration"
