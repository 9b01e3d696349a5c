"""Which runs the benchmark makes, and the rows of results that come of each."""
import tempfile
from pathlib import Path

import errors
import methods
import truths

LISTS = ('whole', 'layers', 'alone')


def run_lists(scene, wanted):
    """(words for lsde's command line, [(class, layer of the picture, truth, mask, figure that counts)]) of each run."""
    lists = []
    if 'whole' in wanted:
        masks = [(name, None, scene.whole, mask, 'relMSE') for name, mask in scene.masks.items()]
        lists.append(((), [('whole', None, scene.whole, None, 'relMSE'), *masks]))
    if 'layers' in wanted and scene.layers:
        names = {expression: truths.LAYERS[expression] for expression in scene.layers}
        words = [word for expression, name in names.items() for word in ('--paths', f'{expression}={name}')]
        lists.append((words, [(f'layer {expression}', names[expression], truth, None, 'norm')
                              for expression, truth in scene.layers.items()]))
    if 'alone' in wanted:
        above, belows = truths.YARDSTICK
        lists += [(('--only', expression), [(f'alone {expression}', None, scene.layers[expression], None, 'norm')])
                  for expression in (above, *belows) if expression in scene.layers and above in scene.layers]
    return lists


def measure(runs, classes, scene, common):
    """A row for each path class that the runs' pictures hold."""
    rows = []
    for path_class, layer, truth, mask, figure in classes:
        pictures = [truths.load_averaged(run.picture, truth, layer) for run in runs]
        rows.append(common | {'class': path_class, 'digest': scene.digest, 'figure': figure}
                    | errors.figures(pictures, truth, mask))
    return rows


def render_and_measure(name, scene, words, classes, budget, arguments):
    with tempfile.TemporaryDirectory(prefix='lsde-convergence-') as folder:
        runs = [methods.run(methods.METHODS[name], scene, arguments.lsde, budget, seed, Path(folder), words)
                for seed in range(1, arguments.seeds + 1)]
        common = {'scene': scene.name, 'method': name, 'budget': budget, 'cpu': [r.cpu for r in runs]}
        for key in ('cpuSeconds', 'samplesPerPixel', 'photonsEmitted', 'threads'):
            if all(key in r.report for r in runs):
                common[f'reported.{key}'] = [r.report[key] for r in runs]
        return measure(runs, classes, scene, common)


def plan(scenes, arguments):
    """(scene, words, classes, method, budget) of each run, and (scene, method, reason) of those left out."""
    runs, left_out = [], []
    for scene in scenes:
        for name in arguments.methods:
            reason = methods.METHODS[name].needs(scene)
            if reason:
                left_out.append((scene.name, name, reason))
                continue
            for words, classes in run_lists(scene, arguments.lists):
                if words and not methods.METHODS[name].filters:
                    left_out.append((scene.name, name, f'cannot render {", ".join(c[0] for c in classes)} apart'))
                    continue
                runs += [(scene, words, classes, name, budget) for budget in arguments.budgets]
    return runs, left_out
