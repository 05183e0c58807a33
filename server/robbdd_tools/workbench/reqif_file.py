"""Requirements in ReqIF, the exchange format of requirements tools. No other module uses the package ``reqif``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import NAMESPACE_URL, uuid5
from xml.etree import ElementTree

from robbdd_tools.workbench.requirement_table import Names, RequirementRow, TableProblem

if TYPE_CHECKING:
    from types import ModuleType

SUFFIX = ".reqif"
NAMES: Mapping[str, tuple[str, ...]] = {
    "id": ("reqif.foreignid", "id", "identifier", "uid", "object identifier"),
    "name": ("reqif.name", "name", "short name"),
    "text": ("reqif.text", "text", "description", "object text", "statement"),
    "heading": ("reqif.chaptername", "heading", "object heading"),
    "source": ("source", "reqif.source", "reference"),
}
"""Maps each column to the names, in lower case, that other tools give the attribute."""
WRITTEN = ("ReqIF.ForeignID", "ReqIF.Name", "ReqIF.Text", "Source", "Scenarios", "Verdict")
_BLOCKS = {"br", "p", "div", "li", "tr"}
_DOCTYPE = re.compile(r"<!(?:DOCTYPE|ENTITY)", re.IGNORECASE)
_PLACE = re.compile(r"line (\d+), column (\d+)")


def read_reqif(file: Path, text: str) -> list[RequirementRow]:
    """Return the requirements of a ReqIF file, in the order of its specifications. Headings are left out.

    Raises ``TableProblem``.
    """
    found = _DOCTYPE.search(text)
    if found is not None:
        raise TableProblem(f"{_at(file, text, found.start())}: ReqIF has no document type: remove it and its entities")
    parser, errors = _package(file.name, "parser"), _package(file.name, "models.error_handling")
    try:
        bundle = parser.ReqIFParser.parse_from_string(text)
    except errors.ReqIFXMLParsingError as error:
        place = _PLACE.search(str(error))
        line, column, kind = (place[1], place[2], "XML") if place is not None else ("1", "1", "ReqIF")
        reason = _PLACE.sub("", str(error)).partition(" (")[0].strip(" ,.")
        raise TableProblem(f"{file}:{line}:{column}: this is no {kind}: {reason}") from None
    except Exception as error:  # The package raises any type of exception for what it cannot read.
        raise TableProblem(_unusable(file, error)) from None
    objects = list(_objects(bundle))
    if not objects:
        raise TableProblem(f"{file}:1:1: there is no SPEC-OBJECT: export the requirements, not only their relations")
    names = Names()
    return [row for row in (_row(file, text, bundle, one, names) for one in objects) if row is not None]


def reqif_text(file: Path, rows: Sequence[RequirementRow]) -> str:
    """Return requirements with their coverage as ReqIF. Equal rows give equal files. Raises ``TableProblem``."""
    load = {name: _package(file.name, f"models.reqif_{name}") for name in _MODELS}
    kinds: Any = load["types"].SpecObjectAttributeType
    string, xhtml = load["data_type"].ReqIFDataTypeDefinitionString, load["data_type"].ReqIFDataTypeDefinitionXHTML
    types = [
        string(_id("string"), long_name="String", last_change=_DATE, max_length="32000"),
        xhtml(_id("xhtml"), long_name="XHTML", last_change=_DATE),
    ]
    definitions: list[Any] = []
    for name in WRITTEN:
        of_text = name == "ReqIF.Text"
        kind, data = (kinds.XHTML, "xhtml") if of_text else (kinds.STRING, "string")
        definition = load["spec_object_type"].SpecAttributeDefinition
        definitions.append(definition(kind, _id(name), _id(data), last_change=_DATE, long_name=name))
    requirement = load["spec_object_type"].ReqIFSpecObjectType(
        _id("requirement"), last_change=_DATE, long_name="Requirement", attribute_definitions=definitions
    )
    specification = load["specification_type"].ReqIFSpecificationType(
        _id("specification"), last_change=_DATE, long_name="Specification", is_self_closed=True
    )
    objects: list[Any] = []
    children: list[Any] = []
    for row in rows:
        texts = (row.identifier or row.name, row.name, row.text, row.source, "; ".join(row.scenarios), row.verdict)
        value = load["spec_object"].SpecObjectAttribute
        values = [
            value(kinds.XHTML, _id(name), _xhtml(text))
            if name == "ReqIF.Text"
            else value(kinds.STRING, _id(name), " ".join(text.split()))
            for name, text in zip(WRITTEN, texts, strict=True)
        ]
        key = _id(f"requirement {row.name}")
        objects.append(
            load["spec_object"].ReqIFSpecObject(key, values, _id("requirement"), None, _DATE, escape(row.name))
        )
        hierarchy = load["spec_hierarchy"].ReqIFSpecHierarchy
        children.append(hierarchy(identifier=_id(f"place {row.name}"), spec_object=key, level=1, last_change=_DATE))
    whole = load["specification"].ReqIFSpecification(
        _id("all"), None, _DATE, "Requirements", [], _id("specification"), children
    )
    content = load["req_if_content"].ReqIFReqIFContent(types, [requirement, specification], objects, [], [whole], [])
    header = load["reqif_header"].ReqIFReqIFHeader(
        _id("header"), "", _DATE, "robbdd", "robbdd", "1.0", "robbdd", "Requirements"
    )
    bundle = _package(file.name, "reqif_bundle").ReqIFBundle(
        load["namespace_info"].ReqIFNamespaceInfo.create_default(),
        header,
        load["core_content"].ReqIFCoreContent(content),
        False,
        _package(file.name, "object_lookup").ReqIFObjectLookup.empty(),
        [],
    )
    text: str = _package(file.name, "unparser").ReqIFUnparser.unparse(bundle)
    return text


_MODELS = (
    *("types", "data_type", "spec_object_type", "specification_type", "spec_object", "spec_hierarchy"),
    *("specification", "req_if_content", "reqif_header", "namespace_info", "core_content"),
)
_DATE = "2000-01-01T00:00:00Z"
"""Date of all changes. ReqIF demands dates, but they are not known, and equal requirements must give equal files."""


def _package(name: str, module: str) -> Any:
    try:
        found: ModuleType = import_module(f"reqif.{module}")
    except ImportError:
        raise TableProblem(f"{name} needs the package reqif: install robbdd-tools[reqif], or use a .csv") from None
    return found


def _unusable(file: Path, error: Exception) -> str:
    """Return the message about a file that the package does not understand. Many of its errors name an XML element."""
    elements: list[Any] = [one for one in error.args if getattr(one, "sourceline", None)]
    if not elements:
        return f"{file}:1:1: this is no ReqIF: {str(error) or type(error).__name__}"
    line, name = elements[0].sourceline, str(elements[0].tag).rpartition("}")[2]
    return f"{file}:{line}:1: this is no ReqIF: a {name} is incomplete, or has a part that ReqIF does not define"


def _objects(bundle: Any) -> Iterator[Any]:
    """Yield the objects of all specifications in their order, then the objects outside of specifications, each once."""
    content = None if bundle.core_content is None else bundle.core_content.req_if_content
    every = {} if content is None else {one.identifier: one for one in content.spec_objects or ()}
    for specification in () if content is None else content.specifications or ():
        for place in bundle.iterate_specification_hierarchy(specification):
            if place.spec_object in every:
                yield every.pop(place.spec_object)
    yield from every.values()


def _row(file: Path, text: str, bundle: Any, found: Any, names: Names) -> RequirementRow | None:
    """Return an object as a requirement; ``None`` if it is a heading."""
    kind = bundle.get_spec_object_type_by_ref(found.spec_object_type)
    titles = {} if kind is None else {key: one.long_name or key for key, one in kind.attribute_map.items()}
    values = {
        str(titles.get(one.definition_ref, one.definition_ref)).lower(): _plain(one)
        for one in found.attributes
        if isinstance(one.value, str)
    }

    def value(meaning: str) -> str:
        return next((values[name] for name in NAMES[meaning] if values.get(name)), "")

    words = value("text")
    if not words and value("heading"):
        return None
    if not words:
        start = text.find(f'"{found.identifier}"')
        known = ", ".join(sorted(repr(name) for name in values)) or "none"
        raise TableProblem(
            f"{_at(file, text, start)}: '{found.identifier}' has no text in an attribute such as 'ReqIF.Text'; "
            f"its attributes are {known}"
        )
    identifier = value("id") or found.long_name or found.identifier
    name = names.free(value("name"), 0) or names.made(identifier, 0)
    return RequirementRow(name, "" if identifier == name else identifier, words, value("source"))


def _plain(attribute: Any) -> str:
    """Return the text of a value. Each element of formatted text begins a new line."""
    value = str(attribute.value).strip()
    if attribute.value_stripped_xhtml is None:
        return value
    try:
        root = ElementTree.fromstring(f"<text>{attribute.value_stripped_xhtml}</text>")
    except ElementTree.ParseError:
        return re.sub(r"<[^>]*>", "", value)
    lines = "".join(_words(root)).split("\n")
    return "\n".join(line for line in (" ".join(one.split()) for one in lines) if line)


def _words(node: ElementTree.Element) -> Iterator[str]:
    block = node.tag.rpartition("}")[2].lower() in _BLOCKS
    yield ("\n" if block else "") + " ".join((node.text or "").split("\n"))
    for child in node:
        yield from _words(child)
        yield " ".join((child.tail or "").split("\n"))
    yield "\n" if block else ""


def _xhtml(text: str) -> str:
    return f"<xhtml:div>{'<xhtml:br/>'.join(escape(line) for line in text.splitlines())}</xhtml:div>"


def _id(words: str) -> str:
    return f"_{uuid5(NAMESPACE_URL, f'robbdd requirements {words}')}"


def _at(file: Path, text: str, offset: int) -> str:
    before = text[: max(offset, 0)]
    return f"{file}:{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
