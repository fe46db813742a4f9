/*
 * A binary tree, outwards from the gateway.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tree.h"

#include <cstddef>
#include <deque>
#include <vector>

namespace tsr
{

namespace
{

constexpr int kChildrenMax = 2;

double distance2(const SiteNode &a, const SiteNode &b)
{
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double step = a.position_m[axis] - b.position_m[axis];
        sum += step * step;
    }
    return sum;
}

/* The nearest of the nodes to one of them; left.size() if none is within the reach. */
std::size_t nearest(const std::vector<SiteNode *> &left, const SiteNode &to, double reach2)
{
    std::size_t best = left.size();
    for (std::size_t i = 0; i < left.size(); ++i) {
        const double away2 = distance2(*left[i], to);
        if (away2 <= reach2 && (best == left.size() || away2 < distance2(*left[best], to))) {
            best = i;
        }
    }
    return best;
}

} // namespace

void join_tree(Site &site, double reach_m)
{
    std::vector<SiteNode *> left;
    std::deque<SiteNode *> open; /* may take children, the nearest to the gateway first */
    for (SiteNode &node : site.nodes) {
        if (node.role == Role::gateway) {
            open.push_back(&node);
        } else if (node.role != Role::wing) {
            left.push_back(&node);
        }
    }
    std::vector<SiteNode *> joined;
    const auto join = [&](std::size_t i, const SiteNode &parent) {
        SiteNode *node = left[i];
        node->parent = parent.id;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        open.push_back(node);
    };
    while (!left.empty()) {
        if (open.empty()) { /* nobody reaches the rest: the shortest way over, from whoever it is */
            std::size_t best = 0;
            const SiteNode *parent = joined.front();
            for (const SiteNode *candidate : joined) {
                const std::size_t i = nearest(left, *candidate, 1e30);
                if (distance2(*left[i], *candidate) < distance2(*left[best], *parent)) {
                    best = i;
                    parent = candidate;
                }
            }
            join(best, *parent);
            continue;
        }
        SiteNode *parent = open.front();
        open.pop_front();
        joined.push_back(parent);
        for (int child = 0; child < kChildrenMax && !left.empty(); ++child) {
            const std::size_t i = nearest(left, *parent, reach_m * reach_m);
            if (i == left.size()) {
                break;
            }
            join(i, *parent);
        }
    }
}

} // namespace tsr
