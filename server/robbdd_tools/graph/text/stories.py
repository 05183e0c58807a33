"""Write user stories, variants and variations of a graph as RobBDD text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import EventClause, Iri
from robbdd_tools.graph.rdf.records import Incomplete, items_of
from robbdd_tools.graph.rdf.vocabulary import SELECTIONS
from robbdd_tools.graph.read.clauses import ClauseReader
from robbdd_tools.graph.text.clauses import ClauseText
from robbdd_tools.graph.text.names import Names, braces, indented, quoted
from robbdd_tools.graph.text.property_text import base_of, set_reference
from robbdd_tools.graph.text.requirements import verified
from robbdd_tools.graph.text.scenes import SceneText
from robbdd_tools.syntax.when_paths import when_path

if TYPE_CHECKING:
    from rdflib.term import Node


@dataclass(frozen=True, slots=True)
class StoryText:
    """Writes user stories.

    ``variables`` maps each template to the references by which a story names the template's variables. ``left_out``
    maps each node that cannot be written to the reason.
    """

    names: Names
    scenes: SceneText
    reader: ClauseReader
    variables: Mapping[str, Mapping[str, str]]
    left_out: dict[str, str]

    def text(self, story: Iri) -> str:
        """Return the text of a user story. Raises ``Incomplete`` if none of its variants can be written."""
        records, names = self.names.records, self.names
        namespace = names.split(story)[0]
        name = names.paths[story]
        variants: list[str] = []
        for node in records.iris(records.ordered(story, "bdd:has-criteria", "rbw:criteria-list")):
            try:
                variants.append(self._variant(node, name, namespace))
            except Incomplete as error:
                self.left_out[node] = str(error)
        if not variants:
            raise Incomplete("it has no scenario that can be written")
        texts = [records.text(story, f"rbw:{part}") for part in ("role", "feature", "benefit")]
        role, feature, benefit = map(quoted, texts)
        head = f"As A {role}\nI Want {feature}\nSo That {benefit}\n\n" if any(texts) else ""
        head += f"{links}\n\n" if (links := verified(names, story, "verifies:")) else ""
        inner = indented(f"{head}Scenarios:\n{indented((chr(10) * 2).join(variants))}")
        return f"User Story (ns={names.prefix(namespace)}) {name} {{\n{inner}\n}}"

    def _variant(self, node: Iri, story: str, namespace: str) -> str:
        names, records = self.names, self.names.records
        template = records.one(node, "bdd:of-template")
        if template not in self.variables:
            raise Incomplete(f"its template {template} is not written")
        name = names.declare(node, "scenario", owner=story, namespace=namespace)
        owner = f"{story}.{name}"
        writer = ClauseText(names, owner, namespace, dict(self.variables[template]))
        clauses = [self.reader.clause(clause) for clause in items_of(records, node, "bdd:has-clause")]
        events = writer.events([clause for clause in clauses if isinstance(clause, EventClause)], when_path("", 0))
        parts = [
            f"template: {names.reference(template)}",
            f"scene: {self.scenes.scenes[node]}",
            verified(names, node, "verifies:"),
            writer.conditions(clauses, "given"),
            "When:\n" + indented("\n".join(events)) if events else "",
            writer.conditions(clauses, "then"),
            "variation:\n" + indented(self._variation(node, template, owner, namespace)),
        ]
        return f"Scenario {name} {{\n{indented(chr(10).join(part for part in parts if part))}\n}}"

    def _variation(self, variant: Iri, template: Iri, owner: str, namespace: str) -> str:
        records = self.names.records
        node = records.one(variant, "bdd:has-variation")
        variables = [self._variable(template, variable) for variable in items_of(records, node, "bdd:variable-list")]
        if not variables:
            raise Incomplete("its variation gives no variable a value")
        if records.is_a(node, "bdd:TableVariation"):
            rows = [self._row(row, len(variables)) for row in records.list_of(node, "bdd:rows")]
            return "\n".join([_line(variables), "|" + "---|" * len(variables), *map(_line, rows)])
        entries = records.list_of(node, "bdd:of-sets")
        if len(entries) != len(variables):
            raise Incomplete(f"its variation has {len(entries)} sets for {len(variables)} variables")
        typed = [records.is_a(str(name), "bdd:Set") for name in items_of(records, node, "bdd:variable-list")]
        return "\n".join(
            self._assignment(name, is_set, entry, f"{namespace}{{}}-{owner}.{index}")
            for index, (name, is_set, entry) in enumerate(zip(variables, typed, entries, strict=True))
        )

    def _variable(self, template: str, node: Node) -> str:
        reference = self.variables[template].get(str(node))
        if reference is None:
            raise Incomplete(f"its variation gives a value to {node}, which its template does not have")
        return reference

    def _row(self, row: Node, width: int) -> list[str]:
        cells = self.names.records.items(row)
        if cells is None or len(cells) != width:
            raise Incomplete("a row of its variation does not have one cell for each variable")
        return [self._cell(cell) for cell in cells]

    def _cell(self, node: Node) -> str:
        items = self.names.records.items(node)
        if items is not None:
            return braces(self.names.value(item) for item in items)
        return self.scenes.link(str(node)) if self._is_set(node) else self.names.value(node)

    def _is_set(self, node: Node) -> bool:
        base = base_of(self.names, str(node))
        return base in self.scenes.kinds or base in self.scenes.constant_sets

    def _assignment(self, variable: str, is_set: bool, entry: Node, made: str) -> str:
        records = self.names.records
        items = records.items(entry)
        if items is not None:
            lists = [records.items(item) for item in items]
            if lists and all(inner is not None for inner in lists):
                return f"set var {variable}: {braces(self._cell(item) for item in items)}"
            return f"{'set ' if is_set and not items else ''}var {variable}: {self._cell(entry)}"
        for kind, type_ in SELECTIONS.items():
            if records.is_a(str(entry), type_):
                return f"set var {variable}: {self._selection(Iri(entry), kind, made)}"
        return f"var {variable}: {self._cell(entry)}"

    def _selection(self, node: Iri, kind: str, made: str) -> str:
        records, names = self.names.records, self.names
        iri = made.format("comb" if kind == "combinations" else "perm")
        if iri != node:
            names.renamed[node] = iri
        repeated = "repeated " if records.text(node, "bdd:repetition-allowed") == "true" else ""
        source = set_reference(names, records.one(node, "bdd:from"))
        return f"select {records.text(node, 'bdd:length')} {repeated}{kind} from {source}"


def _line(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"
