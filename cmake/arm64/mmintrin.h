// What Eigen includes for SSE2 is there already: eigen_as_sse2.h.
