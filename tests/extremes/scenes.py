"""Extreme but legal scenes: small drapes with one or two parameters at their declared bounds.

The JSON Schema that `drape schema` prints is the only source of parameters: one that a new plugin declares takes part
without being named here. The scenes below are what the parameters are put into, chosen so that most have an effect."""

import copy
import json
import math
import random
from dataclasses import dataclass

FALLING = {"cloth": {"shape": "square", "side": 0.3, "columns": 6, "rows": 6},
           "start": {"translate": [-0.15, -0.15, 0.13], "perturbation": 1e-3},
           "energies": ["neo_hookean", "hinge", {"type": "strain_limit", "limit": 1.1}, "gravity"],
           "contact": ["ipc"], "friction": 0.2,
           "obstacles": [{"meshed_shape": "sphere", "radius": 0.1, "subdivisions": 1},
                         {"meshed_shape": "box", "size": [0.4, 0.4, 0.1], "translate": [0, 0, -0.2]}]}
HUNG = {"cloth": {"shape": "rectangle", "size": [0.3, 0.2], "triangulation": "random", "vertices": 40},
        "pins": [{"region": "ball", "point": [0, 0, 0], "radius": 0.03},
                 {"region": "nearest", "point": [0.3, 0, 0], "translate": [0, 0, -0.02]}],
        "energies": ["stvk", "quadratic_bending", {"type": "gravity", "acceleration": [0, 5, -8]}],
        "contact": ["ipc", "shapes"], "friction": 0.3,
        "obstacles": [{"shape": "sphere", "radius": 0.05, "translate": [0.15, 0.1, -0.06]},
                      {"shape": "half_space", "normal": [0, 0, 1], "translate": [0, 0, -0.3]},
                      {"shape": "capsule", "radius": 0.02, "height": 0.2, "translate": [0, 0.3, -0.1]}]}
DRAGGED = {"cloth": {"shape": "disc", "radius": 0.15, "vertices": 40},
           "start": {"translate": [0, 0, 0.06]},
           "pins": [{"region": "box", "lower": [0.1, -0.2, -0.1], "upper": [0.2, 0.2, 0.1], "translate": [0, 0, 0.06]}],
           "energies": ["neo_hookean", "hinge", "gravity"],
           "contact": ["shapes"],
           "obstacles": [{"shape": "box", "size": [0.1, 0.1, 0.1]},
                         {"shape": "cylinder", "radius": 0.03, "height": 0.08, "translate": [-0.1, 0, 0]}],
           "schedule": {"steps": 2, "keys": [{"parameter": "pins.0.translate", "times": [0, 1], "values": [[0, 0, 0.06], [0.02, 0, 0.05]]}]}}
PULLED = {"cloth": {"shape": "polygon", "vertices": 40,
                    "loops": [{"points": [0, 0, 0.3, 0, 0.3, 0.3, 0, 0.3]},
                              {"points": [0.1, 0.1, 0.2, 0.1, 0.2, 0.2, 0.1, 0.2]}]},
          "handles": [{"region": "border", "translate": [0, 0, 0.05]}, {"region": "vertices", "vertices": [0], "translate": [0, 0, 0.05], "stiffness": 1e3}],
          "energies": ["neo_hookean", "hinge", {"type": "pressure", "pressure": 5}, "gravity"],
          "contact": ["ipc"],
          "obstacles": [{"meshed_shape": "box", "size": [0.1, 0.1, 0.1], "translate": [0.15, 0.15, -0.1]}]}
SCENES = [FALLING, HUNG, DRAGGED, PULLED]


class Plugin:
    """A step of a path: a plugin's map in a list, or in a place of its own."""

    def __init__(self, name, section):
        self.name, self.section = name, section

    def __str__(self):
        return self.name

    def is_in(self, entry):
        return entry == self.name or isinstance(entry, dict) and entry.get("type") == self.name

    def place(self, scene, kind, rng):
        """The plugin's map in the scene: the one that is there, or a new one."""
        fresh = {"type": self.name, **filled(self.section, rng)}
        if kind == "methods":
            return scene["methods"].setdefault(self.name, {})
        if kind not in ("energies", "contact", "metrics"):
            scene[kind] = fresh
            return fresh
        entries = scene.setdefault(kind, [])
        k = next((k for k, entry in enumerate(entries) if self.is_in(entry)), len(entries))
        if k == len(entries) or entries[k] == self.name:
            entries[k:k + 1] = [fresh]
        return entries[k]


class Obstacle(Plugin):
    """A step of a path: an item of the obstacles, of the contact model `name`."""

    def keys(self):
        """Those that tell its items from another model's."""
        return [rule["required"][0] for rule in self.section["allOf"][0]["anyOf"]]

    def is_in(self, entry):
        return any(key in entry for key in self.keys())

    def place(self, scene, kind, rng):
        """An obstacle of the contact model in the scene: one that is there, or a new one with its model."""
        there = [item for item in scene.setdefault(kind, []) if self.is_in(item)]
        if there:
            return rng.choice(there)
        words = [(key, alternatives(self.section["properties"][key])[0].get("enum")) for key in self.keys()]
        key, enum = next(pair for pair in words if pair[1])  # the others name files
        scene[kind].append({key: rng.choice(enum)})
        models = scene.setdefault("contact", [])
        if not any(super(Obstacle, self).is_in(model) for model in models):
            models.append(self.name)
        return scene[kind][-1]


@dataclass
class Parameter:
    path: tuple  # of keys, plugins, and None for an item of a list
    schema: dict
    nullable: bool

    def __str__(self):
        return ".".join("[]" if step is None else str(step) for step in self.path)

    def extremes(self):
        """The values at the bounds."""
        is_list = self.schema.get("type") == "array"
        values = scalar_extremes(self.schema["items"] if is_list else self.schema)
        if is_list:
            size = self.schema.get("minItems", 1)
            lists = [[v] * size for v in values]
            if size > 1 and len(values) > 1:
                low, high = values[:2]
                lists += [[low] * (size - 1) + [high], [high] + [low] * (size - 1)]
            values = lists
        return values + ([None] if self.nullable else [])


def scalar_extremes(s):
    """Every word; of numbers the smallest and the largest: every number has both bounds (tests/conformance/bounds.cpp)."""
    if "enum" in s:
        return list(s["enum"])
    if s.get("type") == "boolean":
        return [False, True]
    if s.get("type") not in ("number", "integer"):
        return []
    integer = s["type"] == "integer"
    low, high = s.get("minimum"), s.get("maximum")
    if "exclusiveMinimum" in s:
        bound = s["exclusiveMinimum"]
        low = bound + 1 if integer else math.nextafter(bound, math.inf) if bound else 1e-30
    if "exclusiveMaximum" in s:
        bound = s["exclusiveMaximum"]
        high = bound - 1 if integer else math.nextafter(bound, -math.inf)
    return [int(low), int(high)] if integer else [float(low), float(high)]


def alternatives(schema):
    """The schemas that an `anyOf`, nested or not, chooses from."""
    if "anyOf" not in schema:
        return [schema]
    return [a for s in schema["anyOf"] for a in alternatives(s)]


def plugin_name(schema):
    return schema.get("properties", {}).get("type", {}).get("enum", [None])[0]


def parameters_of(schema, path=()):
    """Every parameter below, those of plugins among them."""
    options = alternatives(schema)
    if path == ("obstacles",):
        plugins = [Obstacle(o["description"].split(":")[0].split()[-1], o) for o in alternatives(schema["items"])]
    else:
        plugins = [Plugin(plugin_name(o), o) for o in options if plugin_name(o)]
    for plugin in plugins:
        for key, s in plugin.section["properties"].items():
            if key != "type":
                yield from parameters_of(s, path + (plugin, key))
    if plugins:
        return
    nullable = any(o.get("type") == "null" for o in options)
    for o in options:
        if o.get("type") == "object":
            for key, s in o.get("properties", {}).items():
                yield from parameters_of(s, path + (key,))
            if isinstance(o.get("additionalProperties"), dict):  # a map by name, as the methods are
                yield from parameters_of(o["additionalProperties"], path)
        elif o.get("type") == "array" and any(a.get("type") == "object" for a in alternatives(o["items"])):
            of_plugins = any(plugin_name(a) for a in alternatives(o["items"]))
            yield from parameters_of(o["items"], path if of_plugins else path + (None,))
        elif o.get("type") != "null":
            parameter = Parameter(path, o, nullable)
            if parameter.extremes():
                yield parameter


def filled(section, rng):
    """The least that a section needs, but for a plugin's type."""
    made = {}
    for key in section.get("required", []):
        s = alternatives(section["properties"][key])[0]
        if s.get("type") == "array":
            made[key] = [filled(s["items"], rng)] if s["items"].get("type") == "object" else [0.1] * s.get("minItems", 1)
        elif key != "type":
            made[key] = rng.choice(s["enum"]) if "enum" in s else 0.1
    return made


def put(scene, schema, parameter, value, rng):
    at, section = scene, schema
    steps = list(parameter.path)
    for step, before, after in zip(steps, [None, *steps], steps[1:]):
        if isinstance(step, Plugin):
            at, section = step.place(at, before, rng), step.section
        elif step is None:
            if not at:
                at.append(filled(section, rng))
            at = rng.choice([item for item in at if after in item] or at)
        elif not isinstance(after, Plugin):
            below = alternatives(section["properties"][step])
            section = next(o.get("items", o) for o in below if o.get("type") in ("object", "array"))
            at = at.setdefault(step, [] if after is None else {})
    at[steps[-1]] = value


def steps_there(scene, parameter):
    """How much of the parameter's path the scene has: the more, the likelier it is to have an effect."""
    at, there = scene, 0
    for step in parameter.path:
        if isinstance(step, Plugin):
            found = [entry for entry in at if step.is_in(entry)]
        elif step is None:
            found = sorted(at, key=lambda item: parameter.path[-1] in item, reverse=True)
        else:
            found = [at[step]] if isinstance(at, dict) and step in at else []
        if not found:
            break
        at, there = found[0], there + 1
    return there


def text_of(config):
    return "".join(f"{key}: {json.dumps(value)}\n" for key, value in config.items())


class Case:
    """A scene with some parameters at an extreme."""

    def __init__(self, number, schema, chosen, rng):
        self.number = number
        self.words = ", ".join(f"{p}={json.dumps(v)}" for p, v in chosen)
        there = [sum(steps_there(s, p) for p, _ in chosen) for s in SCENES]
        suited = [s for s, n in zip(SCENES, there) if n == max(there)]
        self.config = {"name": f"extreme_{number}", "levels": 2, **copy.deepcopy(rng.choice(suited)),
                       "newton": {"force_tolerance": 1e-2, "max_steps": 25}, "methods": {}, "snapshots": 2}
        for p, value in chosen:
            put(self.config, schema, p, value, rng)
        if not self.config["methods"]:
            self.config["methods"] = {rng.choice(["pcs", "cascadic", "newton"]): {}}

    def text(self):
        return text_of(self.config)


def cases(schema, seed, count):
    """As many different cases: each parameter at each of its extremes and, in turn, a pair of two."""
    rng = random.Random(seed)
    parameters = list(parameters_of(schema))
    singles = [(p, v) for p in parameters for v in p.extremes()]
    rng.shuffle(singles)
    made = []
    while len(made) < count:
        k = len(made)
        if k % 2 == 0 and k // 2 < len(singles):
            chosen = [singles[k // 2]]
        else:
            first, second = rng.sample(parameters, 2)
            chosen = [(p, rng.choice(p.extremes())) for p in (first, second)]
        made.append(Case(k, schema, chosen, rng))
    return made
