"""Error figures of pictures against a truth: the truth's own noise taken out, variance and bias apart. Needs numpy."""
from dataclasses import dataclass

import numpy as np

DARK = 0.01  # in the denominator of relMSE, (W/(m2 sr))^2: keeps black pixels from weighing infinitely


@dataclass(frozen=True)
class Truth:
    """Radiance, height x width x 3. The halves are independent estimates of it; None where there are none."""
    mean: np.ndarray
    halves: tuple | None = None

    def squared_error(self, picture):
        """By pixel and channel. With halves its expectation is free of the truth's noise, and it may be negative."""
        a, b = self.halves or (self.mean, self.mean)
        return (picture - a) * (picture - b)

    @property
    def noise(self):
        """Estimated variance of the mean, by pixel and channel; zero where there are no halves to tell."""
        a, b = self.halves or (self.mean, self.mean)
        return ((a - b) / 2) ** 2


def box_average(picture, height):
    """The picture at a whole fraction of its size: what a box filter of one large pixel would have given."""
    k = picture.shape[0] // height
    if k <= 1:
        return picture
    h, w = picture.shape[0] // k, picture.shape[1] // k
    return picture[:h * k, :w * k].reshape(h, k, w, k, -1).mean((1, 3))


def block_sem(values, mask, size=8):
    """Standard error of the mean of values over the mask, from the spread of blocks about their expected sums.
    Too large where the expected values themselves vary over the picture."""
    h, w = (n // size * size for n in values.shape)
    sums, counts = (x[:h, :w].reshape(h // size, size, w // size, size).sum((1, 3)).ravel()
                    for x in (values * mask, mask.astype(float)))
    deviations = (sums - counts * (sums.sum() / counts.sum()))[counts > 0]
    return float(np.sqrt((deviations ** 2).sum()) / counts.sum())


def weights(truth, mask):
    """Of squared errors. relMSE: error relative to each pixel; norm: per energy, for dim pictures and single layers,
    where DARK hides all."""
    energy = (truth.mean[mask] ** 2).mean()
    return {'relMSE': 1 / (truth.mean ** 2 + DARK), 'norm': 1 / max(energy, 1e-30)}


def figures(pictures, truth, mask=None):
    """Figures of equally made pictures that differ in their seed alone, each of the truth's shape.

    By weight (relMSE, norm): error      expected error of one picture; with halves, free of the truth's noise
                              error_sem  its standard error, over blocks of 8x8 pixels; likewise for bias2
                              variance   what more time takes away: mean of (I - mean of I)^2 * K / (K - 1)
                              bias2      what is left with any number of seeds: error of the mean - variance / K
    error = variance + bias2, exactly. With one seed the latter two are None. bias2 is not clamped: about zero its
    noise takes it below. With a truth without halves ("corrected" is false) error and bias2 hold the truth's noise.
    """
    count = len(pictures)
    mask = np.ones(truth.mean.shape[:2], bool) if mask is None else mask
    not_finite = sum(int((~np.isfinite(p)).any(2).sum()) for p in pictures)
    pictures = [np.nan_to_num(p, nan=0, posinf=0, neginf=0) for p in pictures]  # as black; counted above
    mean = sum(pictures) / count
    error = sum(truth.squared_error(p) for p in pictures) / count
    if count > 1:
        variance = sum((p - mean) ** 2 for p in pictures) / (count - 1)
        bias2 = truth.squared_error(mean) - variance / count
    result = dict(pixels=int(mask.sum()), not_finite=not_finite, corrected=truth.halves is not None,
                  ratio=float(mean[mask].mean() / max(truth.mean[mask].mean(), 1e-30)))
    for name, weight in weights(truth, mask).items():
        def average(squares):
            return float((squares * weight).mean(2)[mask].mean())

        def sem(squares):
            return block_sem((squares * weight).mean(2), mask)

        result[name] = dict(error=average(error), error_sem=sem(error), truth_noise=average(truth.noise),
                            variance=average(variance) if count > 1 else None,
                            bias2=average(bias2) if count > 1 else None, bias2_sem=sem(bias2) if count > 1 else None)
    return result
