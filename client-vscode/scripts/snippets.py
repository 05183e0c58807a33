"""Writes the extension's snippets of whole declarations, which are the server's: ``snippets.py [FOLDER]``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from robbdd_tools.features.snippets import declaration_snippets
from robbdd_tools.syntax.parse import LANGUAGES

FOLDER = Path(__file__).parent.parent / "snippets" / "declarations"


def main(folder: Path) -> None:
    """Write one file for each kind of file, into an existing folder."""
    for language in LANGUAGES:
        found = {
            # The name is what stands beside the suggestion: it tells this one from the keyword alone.
            f"{snippet.label}: whole declaration": {
                "prefix": snippet.label,
                "body": snippet.body.split("\n"),
            }
            for snippet in declaration_snippets(language)
        }
        text = json.dumps(found, indent=2, ensure_ascii=False)
        (folder / f"{language}.json").write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
