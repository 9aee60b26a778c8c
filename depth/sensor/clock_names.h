#pragma once
#include <optional>
#include <string>
#include <vector>

namespace ossa::depth {

/// The times of frames whose names contain a clock, beside other numbers or in parts: a date and
/// time with thousandths or more (2024-05-01_12-59-58-900, 20240501125958900), a time of day with
/// them, seconds since 1970 and a fraction (1714568398_900000000, as ROS dumps have them), or
/// milli-, micro- or nanoseconds since 1970 beside a count (000017_1714568398900). Seconds of each
/// name, since the earliest; none if the names contain no such clock, or if its steps are not those
/// of a camera: the number is a count then.
std::optional<std::vector<double>> ReadTimesFromClocks(const std::vector<std::string>& stems);

}  // namespace ossa::depth
