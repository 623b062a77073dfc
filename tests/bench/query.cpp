// One CARP query, by hand, in the order of `query/ties`: the yardstick of tests/bench. Resources of capacity 1 only.
//
// Reads the numbers that bench_speed.py writes, asks each query again and again, and writes for each its arrival and
// the nanoseconds that it takes.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>
#include <vector>

struct Window {
    int32_t start, end, source;  // the robot that ends it comes from `source`
};

struct Row {
    int32_t first, last;
};

static std::vector<Row> rows, moves;
static std::vector<Window> windows;
static std::vector<int32_t> resource_of, targets, reached, generation_of;
static std::vector<int64_t> guide;  // ticks to the goal times 2^32, plus the rank
static std::vector<std::pair<int64_t, int32_t>> heap;
static int32_t generation = 0;

static int read() {
    int value = 0;
    if (std::scanf("%d", &value) != 1) std::abort();
    return value;
}

// The tick of arrival of a robot of pace 1 on unit durations, or -1.
static int query(int start, int release, int goal) {
    ++generation;
    heap.clear();
    auto enter = [](int window, int tick) {
        reached[window] = tick;
        generation_of[window] = generation;
        heap.emplace_back(-((int64_t(tick) << 32) + guide[resource_of[window]]), window);
        std::push_heap(heap.begin(), heap.end());
    };
    if (guide[start] < 0) return -1;
    int own = rows[start].first;
    while (windows[own].end <= release) ++own;
    enter(own, release);
    while (!heap.empty()) {
        std::pop_heap(heap.begin(), heap.end());
        auto [negative, at] = heap.back();
        heap.pop_back();
        int resource = resource_of[at], tick = reached[at];
        if (-negative != (int64_t(tick) << 32) + guide[resource]) continue;
        if (resource == goal) return tick;
        int ready = tick + 1, end = windows[at].end;
        for (int edge = moves[resource].first; edge < moves[resource].last; ++edge) {
            int target = targets[edge];
            if (guide[target] < 0) continue;
            for (int next = rows[target].first; next < rows[target].last; ++next) {
                const Window& window = windows[next];
                if (window.end <= ready) continue;
                int entry = std::max(ready, window.start);
                if (entry > end) break;
                if (entry + 1 > window.end) continue;
                if (generation_of[next] == generation && reached[next] <= entry) continue;
                if (entry == end && windows[at].source == target) continue;
                enter(next, entry);
            }
        }
    }
    return -1;
}

int main() {
    int count = read(), edges = read(), queries = read(), times = read();
    rows.resize(count);
    moves.resize(count);
    for (int resource = 0; resource < count; ++resource) {
        int size = read();
        rows[resource] = {int32_t(windows.size()), int32_t(windows.size() + size)};
        for (int k = 0; k < size; ++k) {
            int start = read(), end = read(), source = read();
            windows.push_back({start, end, source});
            resource_of.push_back(resource);
        }
    }
    for (int resource = 0; resource < count; ++resource) {
        int size = read();
        moves[resource] = {int32_t(targets.size()), int32_t(targets.size() + size)};
        for (int k = 0; k < size; ++k) targets.push_back(read());
    }
    if (int(targets.size()) != edges) return 1;
    reached.resize(windows.size());
    generation_of.resize(windows.size());
    for (int k = 0; k < queries; ++k) {
        int start = read(), release = read(), goal = read();
        guide.assign(count, -1);
        for (int resource = 0; resource < count; ++resource) {
            int ticks = read(), rank = read();
            guide[resource] = ticks < 0 ? -1 : (int64_t(ticks) << 32) + rank;
        }
        int arrival = query(start, release, goal);
        std::clock_t began = std::clock();  // of the processor, not of the wall
        for (int time = 0; time < times; ++time) query(start, release, goal);
        double took = double(std::clock() - began) / CLOCKS_PER_SEC;
        std::printf("%d %.1f\n", arrival, took * 1e9 / times);
    }
}
