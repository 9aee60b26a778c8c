#!/usr/bin/env python3
"""Golden numbers of tests/tools/experiments/significance_test.cpp, from scipy.

Run: /usr/bin/python3 tests/golden/statistics.py > tests/golden/statistics.txt
(Debian package python3-scipy.) The test runs it again where scipy is installed and compares.
"""
import sys

import numpy as np
import scipy
import scipy.spatial.transform
from scipy import stats

print("# Golden numbers from scipy. Regenerate: tests/golden/statistics.py > tests/golden/statistics.txt")
print("# name, numbers")


def show(name, *numbers):
    print(name, *("%.12g" % float(n) for n in numbers))


random = np.random.RandomState(7)
a = np.round(random.normal(5.0, 1.0, 12), 3)
b = np.round(a + random.normal(0.4, 0.5, 12), 3)
c = np.round(a + random.normal(-0.2, 0.7, 12), 3)
show("a", *a)
show("b", *b)
show("c", *c)
show("wilcoxon_exact", *stats.wilcoxon(a, b, mode="exact"))
big_a = np.round(random.normal(0.0, 1.0, 80), 1)
big_b = np.round(big_a + random.normal(0.1, 0.6, 80), 1)
show("big_a", *big_a)
show("big_b", *big_b)
show("wilcoxon_ties", *stats.wilcoxon(big_a, big_b, mode="approx"))
show("paired_t", *stats.ttest_rel(a, b))
show("friedman", *stats.friedmanchisquare(a, b, c))
show("friedman_ties", *stats.friedmanchisquare(np.round(a), np.round(b), np.round(c)))
show("chi_square_tail", stats.chi2.sf(3.7, 2), stats.chi2.sf(60.0, 40), stats.chi2.sf(0.05, 7))
show("f_tail", stats.f.sf(2.5, 2, 22), stats.f.sf(30.0, 3, 9), stats.f.sf(0.3, 5, 100))
show("student_tail", 2 * stats.t.sf(2.2, 11), 2 * stats.t.sf(0.1, 3), 2 * stats.t.sf(9.0, 30))


# Lilliefors' test: the law of Kolmogorov-Smirnov's distance from the normal law with the sample's own
# mean and deviation, by simulation with a random stream of its own.
simulation = np.random.RandomState(17)


def distance(samples):
    x = np.sort(samples, axis=1)
    n = x.shape[1]
    law = stats.norm.cdf((x - x.mean(1, keepdims=True)) / x.std(1, ddof=1, keepdims=True))
    i = np.arange(n)
    return np.maximum((i + 1) / n - law, law - i / n).max(1)


def lilliefors(sample, count=200000):
    d = distance(sample[None, :])[0]
    return d, (distance(simulation.normal(size=(count, len(sample)))) >= d).mean()


skewed = np.round(simulation.gamma(0.7, 1.0, 12), 3)
far = np.round(np.append(simulation.normal(0, 1, 11), 3.5), 3)
many = np.round(simulation.gamma(3.5, 1.0, 150), 2)
show("skewed", *skewed)
show("far", *far)
show("many", *many)
show("lilliefors_a", *lilliefors(a))
show("lilliefors_skewed", *lilliefors(skewed))
show("lilliefors_far", *lilliefors(far))
show("lilliefors_many", *lilliefors(many, 100000))
# Quantiles of Stephens' (sqrt(n) - 0.01 + 0.85 / sqrt(n)) d, which hardly depends on n.
scale = np.sqrt(20) - 0.01 + 0.85 / np.sqrt(20)
tails = np.array([0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99])
show("lilliefors_tails", *tails)
show("lilliefors_quantiles", *np.quantile(scale * distance(simulation.normal(size=(200000, 20))), 1 - tails))
# Repeated-measures analysis of variance by its definition (sums of squares), F's tail by scipy.
table = np.stack([a, b, c])
grand = table.mean()
between = table.shape[1] * ((table.mean(1) - grand) ** 2).sum()
rest = table - table.mean(1, keepdims=True) - table.mean(0, keepdims=True) + grand
f = (between / 2) / ((rest**2).sum() / 22)
show("anova", f, stats.f.sf(f, 2, 22))
interval = stats.bootstrap((a,), np.mean, method="percentile", n_resamples=50000,
                           random_state=1).confidence_interval
show("bootstrap", interval.low, interval.high)
# Rigid transform: rotation by scipy's Kabsch, translation from the means.
from_points = np.round(random.normal(0, 1, (6, 3)), 3)
to_points = np.round(from_points @ np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0.0]]).T + [1, 2, 3]
                     + random.normal(0, 0.1, (6, 3)), 3)
rotation, _ = scipy.spatial.transform.Rotation.align_vectors(
    to_points - to_points.mean(0), from_points - from_points.mean(0))
show("from", *from_points.ravel())
show("to", *to_points.ravel())
show("rotation", *rotation.as_matrix().ravel())
show("translation", *(to_points.mean(0) - rotation.as_matrix() @ from_points.mean(0)))
print("# scipy", scipy.__version__, file=sys.stderr)
