// What repeated timings say: their middle, their scatter, and whether two sets of them differ.
#pragma once

#include <vector>

namespace lanewise {

// The middle value, or the mean of the two in the middle; 0 of none.
double median(std::vector<double> values);

// Median of the distances from the median, times 1.4826: the standard deviation of normal values, little moved by outliers.
double robust_deviation(const std::vector<double>& values);

// Probability that two sets of values of one distribution, whichever it is, have rank sums at least as unlike as these: the
// exact two-sided test of Wilcoxon, Mann & Whitney (Biometrics Bulletin 1(6), 1945), with the mean rank for equal values. Of
// five against five it is 2/252 at least. 1 if either is empty. Takes time n^4 in n = a.size() + b.size().
double rank_test(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace lanewise
