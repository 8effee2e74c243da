"""What the tests of the module share."""
import unittest

import numpy as np
import sightline

THING = np.dtype([("name", "S3"), ("half", "f4", 3), ("position", "f4", 3), ("exact_half", "f8", 3),
                  ("exact_position", "f8", 3), ("handle", sightline.handle_dtype), ("pair", "u4", 2),
                  ("layer", "u4"), ("number", "u4")])


def row_of_things(count, dtype=THING):
    """Things of 1 m, one behind another, from 5 m ahead on."""
    things = np.zeros(count, dtype)
    for position, half in (("position", "half"), ("exact_position", "exact_half")):
        things[position][:, 2] = -5 - 2 * np.arange(count)
        things[half] = 0.5
    things["layer"] = 1
    things["number"] = 1000 + np.arange(count)
    return things


def boxes_of(things):
    """The same as minimum and maximum, float64 (n, 2, 3)."""
    centre, half = things["exact_position"], things["exact_half"]
    return np.stack([centre - half, centre + half], axis=1)


def read_only(array):
    array = array.copy()
    array.flags.writeable = False
    return array


class Case(unittest.TestCase):
    def refused(self, status, sentence, call, *args, index=None, **kwargs):
        """The call raises a ValueError of this status, whose message says so and names that element."""
        with self.assertRaises(ValueError) as caught:
            call(*args, **kwargs)
        error = caught.exception
        self.assertIsInstance(error, sightline.Refused)
        self.assertEqual((error.status, error.index), (status, index), str(error))
        self.assertIn(sentence, str(error))

    def bad(self, sentence, call, *args, **kwargs):
        self.refused("bad_argument", sentence, call, *args, **kwargs)

    def whole(self, name, call):
        """The argument of this name takes no number but whole ones from 0 on, as far as 64 bits go at most."""
        for number in (-1, 1 << 64, 1 << 99, 0.5, "one", np.int64(-1)):
            self.bad(f"{name}: expected a whole number from 0 to ", call, number)
