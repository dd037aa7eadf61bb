// nanoflann behind the few C functions that nanoflann.rs calls. Points are asked in the order of the tree's leaves.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <nanoflann.hpp>

namespace {

struct Points {
    std::vector<float> xyz;

    size_t kdtree_get_point_count() const { return xyz.size() / 3; }
    float kdtree_get_pt(size_t i, size_t axis) const { return xyz[3 * i + axis]; }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};

using Metric = nanoflann::L2_Simple_Adaptor<float, Points, float, uint32_t>;
using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Points, 3, uint32_t>;

struct Index {
    Points points;
    Tree tree;
    std::vector<uint32_t> list;

    Index(const float* xyz, size_t n)
        : points{std::vector<float>(xyz, xyz + 3 * n)},
          tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(LEAF)) {}

    static constexpr size_t LEAF = 20;

    const std::vector<uint32_t>& order() const {
#if NANOFLANN_VERSION >= 0x150
        return tree.vAcc_;
#else
        return tree.vAcc;
#endif
    }

    template <class Set> void find(Set& set, uint32_t row) const {
#if NANOFLANN_VERSION >= 0x150
        tree.findNeighbors(set, &points.xyz[3 * row], nanoflann::SearchParameters(0, false));
#else
        tree.findNeighbors(set, &points.xyz[3 * row], nanoflann::SearchParams(0, 0, false));
#endif
    }
};

// The receiver of the points that a search by radius finds. The library takes what is nearer than `worstDist`, so that
// is the next number above the square of the radius.
template <class Take> struct Within {
    using DistanceType = float;
    float beyond;
    Take take;

    Within(float radius, Take take)
        : beyond(std::nextafter(radius * radius, std::numeric_limits<float>::infinity())), take(take) {}

    bool addPoint(float, uint32_t row) {
        take(row);
        return true;
    }
    float worstDist() const { return beyond; }
    bool full() const { return true; }
    bool empty() const { return false; }
    size_t size() const { return 0; }
    void sort() {}
};

}  // namespace

extern "C" {

Index* pointmass_nanoflann_new(const float* xyz, size_t n) noexcept {
    Index* index = new Index(xyz, n);
#if NANOFLANN_VERSION < 0x150
    index->tree.buildIndex();
#endif
    return index;
}

void pointmass_nanoflann_delete(Index* index) noexcept { delete index; }

size_t pointmass_nanoflann_bytes(Index* index) noexcept {
    return index->tree.usedMemory(index->tree) + index->points.xyz.size() * sizeof(float);
}

void pointmass_nanoflann_counts(const Index* index, float radius, uint32_t* counts) noexcept {
    for (uint32_t row : index->order()) {
        uint32_t count = 0;
        Within set(radius, [&count](uint32_t) { ++count; });
        index->find(set, row);
        counts[row] = count == 0 ? 0 : count - 1;
    }
}

uint64_t pointmass_nanoflann_lists(Index* index, float radius) noexcept {
    uint64_t total = 0;
    std::vector<uint32_t>& list = index->list;
    for (uint32_t row : index->order()) {
        list.clear();
        Within set(radius, [&list, row](uint32_t other) {
            if (other != row) list.push_back(other);
        });
        index->find(set, row);
        total += list.size();
    }
    return total;
}

// `distances` has room for `k` of each point; there are more than `k` points.
void pointmass_nanoflann_nearest(const Index* index, size_t k, float* distances) noexcept {
    std::vector<uint32_t> rows(k + 1);
    std::vector<float> squares(k + 1);
    for (uint32_t row : index->order()) {
        nanoflann::KNNResultSet<float, uint32_t> set(k + 1);
        set.init(rows.data(), squares.data());
        index->find(set, row);
        // The point itself is the nearest, or as near as the nearest.
        for (size_t i = 0; i < k; ++i) distances[row * k + i] = std::sqrt(squares[i + 1]);
    }
}

}
