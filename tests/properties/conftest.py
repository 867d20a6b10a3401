"""Properties that hold for whatever hypothesis comes up with: the same few examples every time, or, with
`pytest tests/properties --hypothesis-profile=thorough`, many others."""

from hypothesis import HealthCheck, settings

_SLOW = [HealthCheck.too_slow]
settings.register_profile(
    "quick", derandomize=True, deadline=None, max_examples=20, database=None, suppress_health_check=_SLOW
)
settings.register_profile("thorough", deadline=None, max_examples=500, database=None, suppress_health_check=_SLOW)
settings.load_profile("quick")
