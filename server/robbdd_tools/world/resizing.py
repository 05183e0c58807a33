"""Objects of another size than the catalog's: stretched upwards, widened, or scaled as a whole."""

from __future__ import annotations

from dataclasses import replace

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind, Vector
from robbdd_tools.world.extent import bounds_of

Factors = tuple[float, float, float]


def stretched(model: ObjectModel, factor: float) -> ObjectModel:
    """Stretch an object upwards from its lowest point. Its mass stays."""
    return _scaled(model, (1.0, 1.0, factor))


def widened(model: ObjectModel, factor: float) -> ObjectModel:
    """Scale an object along x and y, walls included. Its height and its mass stay."""
    return _scaled(model, (factor, factor, 1.0))


def resized(model: ObjectModel, factor: float) -> ObjectModel:
    """Scale an object along all axes. Its mass stays, and its inertia for 1 kg grows with the square of its size."""
    inertia = model.inertia
    if inertia is not None:
        x, y, z = inertia.center
        xx, yy, zz, xy, xz, yz = (factor**2 * moment for moment in inertia.moments)
        inertia = replace(inertia, center=(factor * x, factor * y, factor * z), moments=(xx, yy, zz, xy, xz, yz))
    rest, frame = factor * model.rest_height, model.frame
    scaled = replace(_scaled(model, (factor, factor, factor)), rest_height=rest, inertia=inertia)
    return replace(scaled, frame=(factor * frame[0], factor * frame[1], factor * frame[2]))


def extent_of(model: ObjectModel) -> tuple[float, float]:
    """Return the width along x and the height (m) of an object without its belts."""
    low, high = bounds_of(tuple(shape for shape in model.shapes if shape.surface is None))
    return float(high[0] - low[0]), float(high[2] - low[2])


def _scaled(model: ObjectModel, factors: Factors) -> ObjectModel:
    """Scale shapes and regions about the middle of the object's bottom."""
    fx, fy, fz = factors
    bottom = float(bounds_of(model.shapes)[0][2])
    base = bottom * fz if fx == fz else bottom

    def moved(place: Vector) -> Vector:
        return (fx * place[0], fy * place[1], base + fz * (place[2] - bottom))

    def scaled_region(region: Region) -> Region:
        x, y, z = region.half
        return replace(region, center=moved(region.center), half=(fx * x, fy * y, fz * z))

    return replace(
        model,
        shapes=tuple(replace(one, size=_size(one, factors), position=moved(one.position)) for one in model.shapes),
        inertia=None,
        region=None if model.region is None else scaled_region(model.region),
        parts=tuple(map(scaled_region, model.parts)),
    )


def _size(shape: Shape, factors: Factors) -> Vector:
    (a, b, c), (fx, fy, fz) = shape.size, factors
    return (fx * a, fz * b, c) if shape.kind is ShapeKind.CYLINDER else (fx * a, fy * b, fz * c)
