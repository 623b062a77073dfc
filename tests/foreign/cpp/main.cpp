// A planner that speaks carproof's protocol: start, query, plan (by CARP, in the order given), stop.
// `--bug NAME` plants one bug.
#include <iostream>
#include <map>
#include <string>

#include "carp.hpp"
#include "json.hpp"

using json::Value;

namespace {

// An instance with the names of its resources and robots, which are strings or numbers.
struct Named {
    carp::Instance instance;
    std::vector<Value> resources, robots;
};

int index_of(const std::vector<Value>& names, const Value& name) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<int>(i);
    throw std::runtime_error("the id " + name.text + " is not known");
}

long long integer_or(const Value& object, const std::string& name, long long otherwise) {
    const Value* value = object.find(name);
    return value ? value->integer() : otherwise;
}

Named read_instance(const Value& document) {
    Named named;
    const Value& graph = document.at("graph");
    for (const Value& node : graph.at("nodes").items) {
        named.resources.push_back(node.at("id"));
        named.instance.resources.push_back({integer_or(node, "capacity", 1), integer_or(node, "duration", 1), {}});
    }
    const Value* directed = graph.find("directed");
    for (const Value& edge : graph.at("edges").items) {
        int source = index_of(named.resources, edge.at("source"));
        int target = index_of(named.resources, edge.at("target"));
        named.instance.resources[source].successors.push_back(target);
        if (!directed || directed->text != "true") named.instance.resources[target].successors.push_back(source);
    }
    for (const Value& robot : document.at("robots").items) {
        named.robots.push_back(robot.at("id"));
        named.instance.robots.push_back({index_of(named.resources, robot.at("start")),
                                         index_of(named.resources, robot.at("goal")), integer_or(robot, "release", 0),
                                         integer_or(robot, "pace", 1)});
    }
    named.instance.park = document.at("after_goal").text == "park";
    return named;
}

carp::Plan read_visits(const Named& named, const Value& visits) {
    carp::Plan plan;
    for (const Value& visit : visits.items) {
        const Value& leave = visit.items.at(2);
        plan.push_back({index_of(named.resources, visit.items.at(0)), visit.items.at(1).integer(),
                        leave.text == "null" ? carp::forever : leave.integer()});
    }
    return plan;
}

Value visits_document(const Named& named, const carp::Plan& plan) {
    std::vector<Value> visits;
    for (const carp::Visit& visit : plan) {
        Value leave = visit.leave == carp::forever ? Value{} : json::number(visit.leave);
        visits.push_back(json::array({named.resources[visit.resource], json::number(visit.enter), leave}));
    }
    return json::array(visits);
}

Value query(const Value& request, const std::string& bug) {
    const Named named = read_instance(request.at("instance"));
    const int robot = index_of(named.robots, request.at("robot"));
    carp::Planner planner(named.instance, bug);
    carp::Plan before;
    for (const Value& plan : request.at("solution").at("plans").items) {
        const carp::Plan visits = read_visits(named, plan.at("visits"));
        if (plan.at("robot") == named.robots[robot])
            before = visits;
        else
            planner.commit(visits);
    }
    const auto plan = planner.query(robot, before, integer_or(request, "now", 0));
    return json::object({{"plan", plan ? visits_document(named, *plan) : Value{}}});
}

Value plan_all(const Value& request, const std::string& bug) {
    const Named named = read_instance(request.at("instance"));
    carp::Planner planner(named.instance, bug);
    std::vector<Value> plans, order, unplanned;
    for (int robot = 0; robot < static_cast<int>(named.robots.size()); ++robot) {
        const auto plan = planner.query(robot, {}, 0);
        if (!plan) {
            unplanned.push_back(named.robots[robot]);
            continue;
        }
        planner.commit(*plan);
        order.push_back(named.robots[robot]);
        plans.push_back(json::object({{"robot", named.robots[robot]}, {"visits", visits_document(named, *plan)}}));
    }
    return json::object({{"format", json::string("carproof-solution/1")},
                         {"plans", json::array(plans)},
                         {"order", json::array(order)},
                         {"unplanned", json::array(unplanned)}});
}

// The response's field and its value.
std::pair<std::string, Value> answer(const Value& request, const std::string& bug) {
    const std::string op = request.at("op").text;
    if (op == "start")
        return {"result", json::object({{"name", json::string("carp in C++")},
                                        {"version", json::string("1")},
                                        {"ops", json::array({json::string("start"), json::string("query"),
                                                             json::string("plan"), json::string("stop")})}})};
    if (op == "stop") return {"result", json::object({})};
    if (op == "query") return {"result", query(request, bug)};
    const Value* planner = request.find("planner");
    if (op == "plan" && planner && planner->text == "carp") return {"result", plan_all(request, bug)};
    return {"skipped", json::string("this is not offered")};
}

}  // namespace

int main(int count, char** arguments) {
    const std::string bug = count == 3 && arguments[1] == std::string("--bug") ? arguments[2] : "";
    std::string line, op;
    while (op != "stop" && std::getline(std::cin, line)) {
        Value id;
        std::pair<std::string, Value> field;
        try {
            const Value request = json::Reader(line).read_all();
            id = request.at("id");
            op = request.at("op").text;
            field = answer(request, bug);
        } catch (const std::exception& error) {
            field = {"error", json::object({{"kind", json::string("request")},
                                            {"path", json::string("$")},
                                            {"rule", Value{}},
                                            {"message", json::string(error.what())}})};
        }
        std::string out;
        json::write(json::object({{"id", id}, field}), out);
        std::cout << out << std::endl;
    }
}
