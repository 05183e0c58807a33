"""Writes the server's snippets for the test of the extension's colours: ``snippets.py [FOLDER]``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from robbdd_tools.features.part_snippets import PART_SNIPPETS
from robbdd_tools.features.snippets import declaration_snippets
from robbdd_tools.features.study_words import WHOLE
from robbdd_tools.syntax.parse import LANGUAGES
from robbdd_tools.syntax.study_content import STUDY

FOLDER = Path(__file__).parent.parent / "test" / "snippets"


def main(folder: Path) -> None:
    """Write one file for each kind of file, into an existing folder."""
    kinds = {language: (*declaration_snippets(language), *PART_SNIPPETS.get(language, ())) for language in LANGUAGES}
    for language, snippets in {**kinds, STUDY: (WHOLE,)}.items():
        found = {snippet.label: snippet.plain.split("\n") for snippet in snippets}
        text = json.dumps(found, indent=2, ensure_ascii=False)
        (folder / f"{language}.json").write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
