"""What every object of the module refuses, whatever its class."""
import inspect
import unittest

import numpy as np
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


class WrongCalls(Case):
    """A call that no signature fits is refused in one sentence: what, where, what was expected."""

    def test_says_which_argument_and_what_was_expected(self):
        world, view, culler = sightline.World(), sightline.camera(), sightline.Culler()
        for sentence, call in {
            "World(): expected no arguments, got 1": lambda: sightline.World(3),
            "Culler.cull(): argument 'world': expected sightline.World, got int": lambda: culler.cull(1, view),
            "Culler.cull(): argument 'views' is missing": lambda: culler.cull(world),
            "Culler.cull(): argument 'levels': expected sightline.Levels, got str":
                lambda: culler.cull(world, view, levels="fine"),
            "World.insert(): there is no argument 'things'": lambda: world.insert(things=[]),
            "World.insert(): argument 'boxes' is given twice": lambda: world.insert([], boxes=[]),
            "camera(): argument 'fov': expected float, got str": lambda: sightline.camera(fov="wide"),
            "camera(): argument 'near': expected float, got ndarray": lambda: sightline.camera(near=np.zeros((3, 3))),
            "camera(): argument 'width': expected int, got ndarray": lambda: sightline.camera(width=np.zeros(3, int)),
            "camera(): a number is out of range: 'width' = " + str(2**70): lambda: sightline.camera(width=2**70),
            "CullView.min_area: expected float, got str":
                lambda: setattr(sightline.CullView(view), "min_area", "small"),
            "CullView.view: expected sightline.View, got NoneType":
                lambda: setattr(sightline.CullView(view), "view", None),
        }.items():
            with self.subTest(sentence):
                with self.assertRaises(TypeError) as caught:
                    call()
                self.assertEqual(str(caught.exception), sentence)

    def test_or_what_was_raised_when_it_was_asked_what_was_given(self):
        class Nameless:
            def __index__(self):
                return 2**70

            def __str__(self):
                raise KeyError("no text")

        with self.assertRaisesRegex(KeyError, "no text"):
            sightline.camera(width=Nameless())

    def test_never_in_more_than_a_line(self):
        called = 0
        for scope in [sightline, *CLASSES]:
            for name, member in list(vars(scope).items()):
                if not callable(member) or member is sightline.Refused or name.startswith("_") and name != "__init__":
                    continue
                with self.subTest(scope=scope.__name__, member=name):
                    with self.assertRaises((TypeError, ValueError)) as caught:
                        member(*[object()] * 40)
                    self.assertNotIn("\n", str(caught.exception))
                    called += 1
        self.assertGreater(called, 100)


if __name__ == "__main__":
    unittest.main()
