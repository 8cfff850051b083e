"""What all tests share: a property is judged by its examples, not by how long one of them took on a busy machine."""

from hypothesis import settings

settings.register_profile("boatsim", deadline=None, print_blob=True)
settings.load_profile("boatsim")
