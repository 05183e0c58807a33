"""Arithmetic that evaluators share."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.catalog.geometry import cross

NUMBERS = st.floats(width=64) | st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-300, 1e300])
VECTORS = st.lists(st.tuples(*[NUMBERS] * 6), max_size=8)


@given(VECTORS)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_cross_products_have_the_bits_of_numpys(vectors: list[tuple[float, ...]]) -> None:
    both = np.array(vectors, dtype=float).reshape(-1, 6)
    first, second = both[:, :3], both[:, 3:]
    assert cross(first, second).tobytes() == np.cross(first, second).tobytes()


def test_one_vector_is_multiplied_with_each_of_many() -> None:
    one, many = np.array([[1.0, 2.0, 3.0]]), np.arange(12.0).reshape(4, 3)
    assert np.array_equal(cross(one, many), np.cross(one, many))
    assert np.array_equal(cross(many, one), np.cross(many, one))
