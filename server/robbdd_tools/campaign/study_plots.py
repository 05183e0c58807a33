"""Pictures of a study: the counts of outcomes, and the distribution of margins (extra ``plots``)."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_outcomes import Margins, OutcomeTable

FORMATS = (".svg", ".png", ".pdf")
CELL = (1.1, 0.32)
"""Width and height of a cell, inches."""


class PlotsNotInstalled(RobbddError):
    """Seaborn is not installed."""

    def __init__(self) -> None:
        super().__init__("seaborn is not installed: pip install 'robbdd-tools[plots]'")


def draw_outcomes(table: OutcomeTable, path: Path) -> None:
    """Draw a heat map of counts, each cell coloured by its share of the row.

    Raises ``PlotsNotInstalled``, and ``OSError`` if the file cannot be written.
    """
    pyplot, seaborn = _libraries()
    shares = [[count / (sum(row) or 1) for count in row] for row in table.counts]
    width, height = CELL
    size = (2.5 + width * len(table.outcomes), 1.2 + height * len(table.rows))
    figure, axes = pyplot.subplots(figsize=size, layout="constrained")
    seaborn.heatmap(
        shares,
        annot=[list(row) for row in table.counts],
        fmt="d",
        cmap="viridis",
        vmin=0.0,
        vmax=1.0,
        linewidths=0.5,
        xticklabels=list(table.outcomes),
        yticklabels=[", ".join(row) for row in table.rows],
        cbar_kws={"label": "share of the row"},
        ax=axes,
    )
    axes.set_xlabel("holds, or first violated clause")
    axes.set_ylabel(", ".join(table.factors))
    axes.tick_params(axis="y", rotation=0)
    _save(pyplot, figure, path)


def draw_margins(found: Margins, path: Path) -> None:
    """Draw a letter-value plot (Hofmann et al., 2017) of margins; raises like ``draw_outcomes``."""
    pyplot, seaborn = _libraries()
    figure, axes = pyplot.subplots(figsize=(6.0, 1.2 + 0.6 * len(found.levels)), layout="constrained")
    data = [(level, value) for level, values in found.levels.items() for value in values]
    seaborn.boxenplot(x=[value for _, value in data], y=[level for level, _ in data], ax=axes)
    axes.set_xlabel(f"margin of {found.clause}, {found.unit}" if found.unit else f"margin of {found.clause}")
    axes.set_ylabel(found.factor)
    _save(pyplot, figure, path)


def _libraries() -> tuple[Any, Any]:
    try:
        matplotlib: Any = import_module("matplotlib")
        # Ignore users' settings and a matplotlibrc in the working directory, so that equal results give equal files.
        matplotlib.rcdefaults()
        matplotlib.use("Agg")
        matplotlib.rcParams["svg.hashsalt"] = "robbdd"
        # Keep text as text, so that it can be searched and read aloud.
        matplotlib.rcParams["svg.fonttype"] = "none"
        return import_module("matplotlib.pyplot"), import_module("seaborn")
    except ImportError as error:
        raise PlotsNotInstalled from error


def _save(pyplot: Any, figure: Any, path: Path) -> None:
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None, dpi=150)
    pyplot.close(figure)
