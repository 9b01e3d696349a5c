"""The scenes of the benchmark and the truths to hold their pictures against."""
import fnmatch
import hashlib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from errors import Truth, box_average

PROJECT = Path(__file__).resolve().parents[2]

# Path classes that may have a truth of their own: Heckbert's expression, and the end of that truth's file name.
LAYERS = {
    'LS+DE': 'LSpDE',
    'LS+DS+E': 'LSpDSpE',
    'L[DS]?E': 'LE_LDE_LSE',
    'LD+E': 'LDpE',
    'L[DS]*DE': 'DE-ptracer',
}
# The field's yardstick: the error of the first, rendered alone, over that of each other. L[DS]?E stands for LDE: in
# glass-sphere the lamp is out of view, and LD+E is LDE, since the floor cannot light itself.
YARDSTICK = ('LS+DE', ('L[DS]?E', 'LD+E'))

# Closed rooms, where radiance is the same everywhere.
CONSTANTS = {'furnace': 2.0, 'furnace-glass': 2.0}


def load(path, layer=None):
    """A picture as height x width x 3, from OpenEXR (with a layer: its channels LAYER.R, .G, .B) or from .npy."""
    if str(path).endswith('.npy'):
        return np.load(path).astype(np.float64)
    import OpenEXR
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    names = [f'{layer}.{c}' if layer else c for c in 'RGB']
    missing = [n for n in names if n not in channels]
    if missing:
        raise ValueError(f'{Path(path).name}: no channel {missing[0]}, has {" ".join(sorted(channels))}')
    return np.stack([channels[n].pixels for n in names], -1).astype(np.float64)


def load_averaged(path, truth, layer=None):
    picture = box_average(load(path, layer), truth.mean.shape[0])
    if picture.shape != truth.mean.shape:
        raise ValueError(f'{Path(path).name}: {picture.shape[1]}x{picture.shape[0]}, '
                         f'the truth is {truth.mean.shape[1]}x{truth.mean.shape[0]}')
    return picture


def load_truth(stem):
    """STEM.exr is the mean, STEM.a.exr and STEM.b.exr, where there are both, its halves. None without a mean."""
    mean, *halves = (stem.with_name(f'{stem.name}{half}.exr') for half in ('', '.a', '.b'))
    if not mean.exists():
        return None
    return Truth(load(mean), tuple(map(load, halves)) if all(h.exists() for h in halves) else None)


@dataclass
class Scene:
    name: str  # folder/name, such as oracle/pool
    glb: Path
    whole: Truth
    layers: dict = field(default_factory=dict)  # expression -> Truth
    masks: dict = field(default_factory=dict)  # name -> pixels of the whole picture
    mitsuba: Path | None = None  # the same scene for Mitsuba 3
    remark: str = ''

    @cached_property
    def digest(self):
        """Says whether two results were measured on the same scene against the same truths."""
        digest = hashlib.sha256(self.glb.read_bytes())
        for truth in (self.whole, *self.layers.values()):
            digest.update(truth.mean.tobytes())
        return digest.hexdigest()[:16]


def load_layers(stem):
    truths = {expression: load_truth(stem.with_name(f'{stem.name}.{end}')) for expression, end in LAYERS.items()}
    return {expression: truth for expression, truth in truths.items() if truth}


def oracle_masks(oracle, name, say):
    files = sorted((oracle / 'exr').glob('gs1.mask-*.png')) if name == 'glass-sphere' else []
    if not files:
        return {}
    try:
        from PIL import Image
    except ImportError:
        say(f'oracle/{name}: without its masks, which need Pillow')
        return {}
    return {f.stem.removeprefix('gs1.mask-'): np.array(Image.open(f).convert('L')) > 127 for f in files}


def own_masks(reference, name):
    file = reference / f'{name}.masks.exr'
    if not file.exists():
        return {}
    import OpenEXR
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    return {channel.replace('_', '-'): values.pixels > .5 for channel, values in channels.items()}


def oracle_scene(oracle, glb, say):
    stem = oracle / 'exr' / glb.stem
    mitsuba = oracle / 'mitsuba' / f'{glb.stem}.xml'
    return Scene(f'oracle/{glb.stem}', glb, load_truth(stem), load_layers(stem), oracle_masks(oracle, glb.stem, say),
                 mitsuba if mitsuba.exists() else None)


def own_scene(glb, _say):
    """Truths are tests/data/reference; those of a -small scene are of the same with a finer mesh."""
    name = glb.stem.removesuffix('-small')
    if name in CONSTANTS:
        radiance = np.full((64, 64, 3), CONSTANTS[name])
        return Scene(f'scenes/{glb.stem}', glb, Truth(radiance, (radiance, radiance)))
    reference = PROJECT / 'tests/data/reference'
    return Scene(f'scenes/{glb.stem}', glb, load_truth(reference / name), load_layers(reference / name),
                 own_masks(reference, name),
                 remark='the truth has a finer mesh: some bias stays' if glb.stem != name else '')


def find_scenes(oracle, patterns, say):
    """The scenes whose name (oracle/pool) or last part of it (pool) matches a pattern. Says which have no truth.
    oracle: a folder as ../shared/oracle, or None."""
    found = [('oracle', glb) for glb in sorted((oracle / 'glb').glob('*.glb'))] if oracle else []
    found += [('scenes', glb) for glb in sorted((PROJECT / 'scenes').glob('*.glb'))]
    scenes = []
    for folder, glb in found:
        name = f'{folder}/{glb.stem}'
        if not any(fnmatch.fnmatch(n, p) for p in patterns for n in (name, glb.stem)):
            continue
        scene = oracle_scene(oracle, glb, say) if folder == 'oracle' else own_scene(glb, say)
        if scene.whole:
            scenes.append(scene)
        else:
            say(f'{name}: left out, there is no truth for it')
    return scenes
