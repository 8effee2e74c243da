"""What every object of the module refuses, whatever its class."""
import inspect
import unittest

import sightline
from support import Case

CLASSES = [thing for thing in vars(sightline).values()
           if inspect.isclass(thing) and not issubclass(thing, BaseException)]


class Unconstructed(Case):
    """Python can reserve an object and never construct it: nothing of it may be read."""

    def test_no_attribute_reads_what_was_never_written(self):
        self.assertGreater(len(CLASSES), 20)
        asked = 0
        for cls in CLASSES:
            thing = cls.__new__(cls)
            for name, member in vars(cls).items():
                with self.subTest(cls=cls.__name__, member=name):
                    if isinstance(member, property):
                        self.assertRaises(TypeError, getattr, thing, name)
                        asked += 1
                    elif not name.startswith("_") and not isinstance(member, staticmethod):
                        self.assertRaises(TypeError, getattr(thing, name))
                        asked += 1
                    elif name == "__len__":
                        self.assertRaises(TypeError, len, thing)
        self.assertGreater(asked, 60)

    def test_nor_does_a_call_that_takes_it(self):
        world, view = sightline.World(), sightline.camera()
        reserved = {cls: cls.__new__(cls) for cls in CLASSES}
        calls = {
            sightline.World: lambda it: sightline.Culler().cull(it, view),
            sightline.View: lambda it: sightline.Culler().cull(world, it),
            sightline.CullView: lambda it: sightline.Culler().cull(world, it),
            sightline.BoxView: world.insert,
            sightline.Occluder: world.add_occluder,
            sightline.Occlusion: lambda it: sightline.CullView(view, occlusion=it),
            sightline.Light: lambda it: sightline.ShadowCasters().begin(it, view),
        }
        for cls, call in calls.items():
            with self.subTest(cls=cls.__name__):
                self.assertRaises((TypeError, ValueError), call, reserved[cls])

    def test_nor_does_a_call_that_keeps_it(self):
        view = sightline.camera()
        occlusion = sightline.Occlusion.__new__(sightline.Occlusion)
        casters = sightline.ShadowCasters.__new__(sightline.ShadowCasters)
        for call in (lambda: sightline.CullView(view, occlusion=occlusion),
                     lambda: sightline.CullView(view, casters=casters),
                     lambda: sightline.ShadowCasters().receive(sightline.World(), [], occlusion)):
            self.assertRaisesRegex(TypeError, "this object was never constructed", call)

    def test_what_is_constructed_by_hand_can_be_used(self):
        world = sightline.World.__new__(sightline.World)
        world.__init__()
        self.assertEqual(len(world), 0)


if __name__ == "__main__":
    unittest.main()
