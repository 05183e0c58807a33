"""Problems that would prevent placing objects in a run are reported where they are written."""

from __future__ import annotations

import pytest

from checks.models import check, marked
from kit import fixture
from robbdd_tools.features.diagnostics import fast_diagnostics

INSTANCE = """//- main.scenex
import "lab.scene"
ns s = 'https://example.org/s/'
distrib (ns=s) spread { uniform { dimension: 3 lower: (0, 0, 0) upper: (1, 1, 1) } }
distrib (ns=s) flat { normal { dimension: 2 mean: (0, 1) std-dev: 0.5 } }
distrib (ns=s) jitter { normal { dimension: 2 mean: (0, 1) covariance: ((2, 1), (1, 1)) } }
distrib (ns=s) turned { uniform-rotation }
scene inst (ns=s) bench_sim {
//                ^^^^^^^^^ catalog-models what has no model here runs on models of the catalog
    scene: <bench_scene>
    kgraph (ns=s) world {
        body table {
            frame origin {
                pose p { xyz: (1, 2, 3) m orientation: quat { xyzw: (0, 0, 0, 2) } }
            }
            frame edge {
                pose p { wrt: <origin> xyz: sample <spread> m orientation: sample <turned> }
            }
            frame top {
                pose p { wrt: <origin> xyz: (1, 2, 3) m orientation: euler { angles: (0, 0, 90) unit: deg } }
            }
            frame side {
                pose p { wrt: <origin> xyz: (1, 2, 3) m
                    orientation: direction-cosine { x: (1, 0, 0) y: (0, 1, 0) z: (0, 0, 1) } }
            }
        }
    }
}
"""


def test_a_sound_instance_has_no_findings() -> None:
    check(INSTANCE)


@pytest.mark.parametrize(
    ("sound", "broken", "words"),
    [
        ("upper: (1, 1, 1)", "upper: «(1, -1, 1)»", "'spread' has a lower bound above its upper one: a run cannot"),
        ("upper: (1, 1, 1)", "upper: «(1, 1)»", "'spread' has dimension 3, but this has 2"),
        ("mean: (0, 1) std-dev", "mean: «0» std-dev", "'flat' has dimension 2, but this has 1"),
        ("std-dev: 0.5", "std-dev: «0»", "'flat' has a singular covariance"),
        ("((2, 1), (1, 1))", "«((1, 1), (1, 1))»", "'jitter' has a singular covariance"),
        ("((2, 1), (1, 1))", "«((2, 0), (1, 1))»", "'jitter' has a covariance that is not symmetric"),
        ("((2, 1), (1, 1))", "«(2, 1)»", "'jitter' needs a covariance of 2 × 2 numbers"),
    ],
)
def test_a_distribution_that_cannot_be_drawn_from_is_reported(sound: str, broken: str, words: str) -> None:
    check(changed(sound, broken, f"distribution {words}"))


@pytest.mark.parametrize(
    ("sound", "broken", "words"),
    [
        ("p { xyz: (1, 2, 3)", "p { xyz: «(1, 2)»", "a position needs 3 numbers, not 2"),
        ("sample <spread> m", "«sample <flat>» m", "a position needs 3 numbers, not 2"),
        ("sample <spread> m", "«sample <turned>» m", "a position needs 3 numbers, not 4"),
        ("sample <turned> }", "«sample <flat>» }", "an orientation needs 3 angles or a rotation, not 2 numbers"),
        ("(0, 0, 0, 2)", "«(0, 0, 0, 0)»", "a quaternion has 4 numbers, not all of them 0"),
        ("xyzw: (0, 0, 0, 2)", "xyzw: «(0, 0, 1)»", "a quaternion has 4 numbers"),
        ("(0, 0, 90)", "«(0, 90)»", "it has 3 angles"),
        ("x: (1, 0, 0) y: (0, 1, 0) z: (0, 0, 1)", "«x: (1, 0, 0) y: (0, 1, 0) z: (0, 0, 2)»", "at right angles"),
        ("x: (1, 0, 0) y: (0, 1, 0) z: (0, 0, 1)", "«x: (1, 0, 0) y: (0, 1, 0) z: (0, 0, -1)»", "right-handed"),
    ],
)
def test_a_pose_that_places_nothing_is_reported(sound: str, broken: str, words: str) -> None:
    check(changed(sound, broken, f"pose {words}"))


def changed(sound: str, broken: str, expected: str) -> str:
    """Return the instance with a broken part, marked with ``«…»``."""
    assert INSTANCE.count(sound) == 1, sound
    text = INSTANCE.replace(sound, broken.replace("«", "").replace("»", ""))
    return marked(text, broken, expected)


def test_a_pose_is_looked_at_again_when_its_distribution_changes() -> None:
    case = fixture(INSTANCE)
    before = fast_diagnostics(case.snapshot, case.uri)
    text = INSTANCE.partition("\n")[2].replace("3 lower: (0, 0, 0) upper: (1, 1, 1)", "2 lower: (0, 0) upper: (1, 1)")
    case.project.open(case.uri, 2, text)
    after = fast_diagnostics(case.project.snapshot(), case.uri)
    (reported,) = (entry for entry in after if entry.code != "catalog-models")
    assert text[reported.span.start : reported.span.end] == "sample <spread>"
    assert [entry.code for entry in before] == ["catalog-models"]
