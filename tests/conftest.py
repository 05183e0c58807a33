"""Settings of all tests."""

from hypothesis import HealthCheck, settings

# Tests share the cores with one another: how long an example takes says nothing about the code.
settings.register_profile("robbdd", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("robbdd")
