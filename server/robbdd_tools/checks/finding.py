"""Make diagnostics and edits for nodes of syntax trees."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Related

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Severity
    from robbdd_tools.names.elements import Site
    from robbdd_tools.syntax.tree import Node

MAX_OFFERED = 3
"""Maximum number of alternative names or values for which a fix is offered."""


def finding(
    site: Site,
    node: Node,
    severity: Severity,
    code: str,
    message: str,
    related: tuple[Related, ...] = (),
    fixes: tuple[Fix, ...] = (),
) -> Diagnostic:
    """Return a diagnostic on a node of a declaration."""
    return Diagnostic(site.uri, site.span(node), severity, code, message, related, fixes)


def written_text(site: Site, node: Node) -> str:
    """Return the text of a node of a declaration."""
    span = site.span(node)
    return site.file.document.text[span.start : span.end]


def related_to(site: Site, node: Node, message: str) -> Related:
    """Return a node of a declaration as a related place of a diagnostic."""
    return Related(site.uri, site.span(node), message)


def change(site: Site, title: str, node: Node, text: str) -> Fix:
    """Return the fix that replaces a node by ``text``."""
    return Fix(title, (Edit(site.uri, site.span(node), text),))


def listed(names: list[str]) -> str:
    """Return names in quotes, joined as in a sentence."""
    quoted = [f"'{name}'" for name in names]
    return quoted[0] if len(quoted) == 1 else ", ".join(quoted[:-1]) + f" and {quoted[-1]}"


def article(words: str) -> str:
    """Return words with their indefinite article."""
    return f"an {words}" if words[0] in "aeio" else f"a {words}"
