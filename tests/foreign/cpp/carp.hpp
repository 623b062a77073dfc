// Context-aware route planning: one robot against committed plans, by Dijkstra over free time windows.
#pragma once
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace carp {

using Tick = long long;
constexpr Tick forever = std::numeric_limits<Tick>::max() / 4;

struct Resource {
    Tick capacity, duration;
    std::vector<int> successors;
};
struct Robot {
    int start, goal;
    Tick release, pace;
};
struct Visit {
    int resource;
    Tick enter, leave;
};
using Plan = std::vector<Visit>;
struct Instance {
    std::vector<Resource> resources;
    std::vector<Robot> robots;
    bool park = false;
};
struct Window {
    Tick start, end;
};

// The planner, or one with a bug that planners have had: the name of the bug, or nothing.
class Planner {
  public:
    Planner(const Instance& instance, const std::string& bug) : instance_(instance), bug_(bug) {}

    void commit(const Plan& plan) {
        for (std::size_t i = 0; i < plan.size(); ++i) {
            Visit visit = plan[i];
            if (has("parked-robots-forgotten") && visit.leave == forever) visit.leave = visit.enter + 1;
            stays_[visit.resource].push_back(visit);
            if (i + 1 < plan.size()) moves_.insert({plan[i + 1].enter, visit.resource, plan[i + 1].resource});
        }
    }

    // `before` is what the robot has followed until now; without visits it has no plan yet.
    std::optional<Plan> query(int robot, const Plan& before, Tick now) const {
        const Robot& request = instance_.robots[robot];
        if (has("start-is-goal") && request.start == request.goal && before.empty()) return Plan{};
        if (!before.empty() && before.back().leave <= now) {
            if (allows(before)) return before;
            return std::nullopt;
        }
        Plan history;
        for (const Visit& visit : before)
            if (visit.enter <= now) history.push_back(visit);
        if (history.empty()) history.push_back({request.start, request.release, 0});
        Visit& current = history.back();
        current.leave = std::max(current.enter + stay(robot, current.resource), now);
        if (!allows(history)) return std::nullopt;
        return search(robot, history, now);
    }

  private:
    struct Node {
        int resource, window, parent;
        Tick enter, ready;
    };

    const Instance& instance_;
    const std::string& bug_;
    std::map<int, std::vector<Visit>> stays_;
    std::set<std::tuple<Tick, int, int>> moves_;

    bool has(const char* bug) const { return bug_ == bug; }

    Tick stay(int robot, int resource) const {
        Tick ticks = instance_.robots[robot].pace * instance_.resources[resource].duration;
        return has("one-tick-short") ? ticks - 1 : ticks;
    }

    std::vector<Window> windows(int resource) const {
        std::map<Tick, Tick> change{{0, 0}};
        if (auto found = stays_.find(resource); found != stays_.end())
            for (const Visit& visit : found->second) {
                ++change[visit.enter];
                if (visit.leave != forever) --change[visit.leave];
            }
        Tick capacity = instance_.resources[resource].capacity + (has("capacity-off-by-one") ? 1 : 0);
        std::vector<Window> result;
        Tick inside = 0, opened = -1;
        for (auto [tick, by] : change) {
            bool was_touched = has("zero-length-windows") && by == 0 && opened < 0 && tick > 0;
            inside += by;
            if (was_touched && inside >= capacity) result.push_back({tick, tick});
            if (opened < 0 && inside < capacity) opened = tick;
            if (opened >= 0 && inside >= capacity) {
                result.push_back({opened, tick});
                opened = -1;
            }
        }
        if (opened >= 0) result.push_back({opened, forever});
        return result;
    }

    int window_around(const Visit& visit) const {
        const auto free = windows(visit.resource);
        for (std::size_t i = 0; i < free.size(); ++i)
            if (free[i].start <= visit.enter && visit.leave <= free[i].end) return static_cast<int>(i);
        return -1;
    }

    bool is_exchange(Tick tick, int source, int target) const {
        return !has("swaps-ignored") && moves_.count({tick, target, source}) > 0;
    }

    bool allows(const Plan& visits) const {
        for (std::size_t i = 0; i < visits.size(); ++i) {
            if (window_around(visits[i]) < 0) return false;
            if (i > 0 && is_exchange(visits[i].enter, visits[i - 1].resource, visits[i].resource)) return false;
        }
        return true;
    }

    bool can_end(int robot, const Node& node, const Window& window, Tick now) const {
        if (node.resource != instance_.robots[robot].goal) return false;
        if (instance_.park) return window.end == forever || has("goal-unconstrained");
        return node.enter + stay(robot, node.resource) >= now;
    }

    // The earliest entry first; each window once.
    std::optional<Plan> search(int robot, const Plan& history, Tick now) const {
        const Visit& current = history.back();
        std::vector<Node> nodes{{current.resource, window_around(current), -1, current.enter, current.leave}};
        std::map<std::pair<int, int>, Tick> reached;
        using Entry = std::pair<Tick, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        queue.push({current.enter, 0});
        while (!queue.empty()) {
            const int at = queue.top().second;
            queue.pop();
            const Node node = nodes[at];
            const Window window = windows(node.resource)[node.window];
            if (can_end(robot, node, window, now)) return unwind(robot, history, nodes, at);
            for (int target : instance_.resources[node.resource].successors) {
                const auto free = windows(target);
                for (int i = 0; i < static_cast<int>(free.size()); ++i) {
                    const Tick enter = earliest(node, window, target, free[i], stay(robot, target));
                    if (enter < 0) continue;
                    auto [known, is_new] = reached.insert({{target, i}, enter});
                    if (!is_new && known->second <= enter) continue;
                    known->second = enter;
                    Tick ready = enter + stay(robot, target);
                    if (has("zero-length-windows")) ready = std::min(ready, free[i].end);
                    nodes.push_back({target, i, at, enter, ready});
                    queue.push({enter, static_cast<int>(nodes.size()) - 1});
                }
            }
            if (has("endless-search") && queue.empty()) queue.push({current.enter, 0});
        }
        return std::nullopt;
    }

    // The first tick at which the robot can go from the node into the window, or -1.
    Tick earliest(const Node& node, const Window& from, int target, const Window& into, Tick ticks) const {
        Tick enter = std::max(node.ready, into.start);
        while (is_exchange(enter, node.resource, target)) ++enter;
        if (has("zero-length-windows")) return enter <= from.end && enter <= into.end ? enter : -1;
        return enter <= from.end && enter + ticks <= into.end ? enter : -1;
    }

    Plan unwind(int robot, const Plan& history, const std::vector<Node>& nodes, int at) const {
        const Node& last = nodes[at];
        const bool stays = instance_.park || has("never-vanishes");
        Plan plan{{last.resource, last.enter, stays ? forever : last.enter + stay(robot, last.resource)}};
        for (int child = at; nodes[child].parent >= 0; child = nodes[child].parent) {
            const Node& node = nodes[nodes[child].parent];
            plan.push_back({node.resource, node.enter, nodes[child].enter});
        }
        for (std::size_t i = history.size() - 1; i-- > 0;) plan.push_back(history[i]);
        std::reverse(plan.begin(), plan.end());
        return plan;
    }
};

}  // namespace carp
