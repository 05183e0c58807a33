"""The frames in which the drivers of the catalog's arms publish the base of the model.

The models follow the Denavit-Hartenberg parameters of their makers. ``base`` of Universal Robots is turned by half a
turn about z, so it is not listed.
"""

from __future__ import annotations

from collections.abc import Mapping

BASE_FRAMES: Mapping[str, tuple[str, ...]] = {
    "franka-panda": ("panda_link0", "fr3_link0", "link0"),
    "ur10": ("base_link",),
    "kinova-gen3": ("base_link",),
}
"""Catalog robot → names of its base frame in franka_description, ur_description and kortex_description."""
