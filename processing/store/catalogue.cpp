#include "store/catalogue.h"

#include <algorithm>
#include <set>

namespace haustra::store {
namespace {

using Names = Catalogue::Names;

bool contains(const Names& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

// The words on lines of at most `width` columns, each after `margin` spaces.
std::string wrapped(const std::string& text, std::size_t margin, std::size_t width) {
    const std::string indent(margin, ' ');
    std::string lines, line;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        if (!line.empty() && margin + line.size() + 1 + word.size() > width) {
            lines += indent + line + '\n';
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
        at = end + 1;
    }
    return lines + indent + line + '\n';
}

constexpr std::size_t helpColumn = 20, helpWidth = 100;

// "  name   text", the text wrapped beside the name.
std::string entry(const std::string& name, const std::string& text, std::size_t indent) {
    std::string lines = wrapped(text, helpColumn, helpWidth);
    std::string head = std::string(indent, ' ') + name + ' ';
    if (head.size() > helpColumn) return head + '\n' + lines;
    return lines.replace(0, head.size(), head);
}

}  // namespace

const Product* Catalogue::find(std::string_view name) const {
    const auto found = std::ranges::find(products_, name, &Product::name);
    return found == products_.end() ? nullptr : &*found;
}

template <class Condition>
Names Catalogue::namesWhere(Condition condition) const {
    Names names;
    for (const Product& product : products_)
        if (condition(product)) names.push_back(product.name);
    return names;
}

Names Catalogue::stages() const {
    Names names;
    for (const Product& product : products_)
        if (!product.stage.empty() && !contains(names, product.stage))
            names.push_back(product.stage);
    return names;
}

Names Catalogue::madeBy(std::string_view stage) const {
    return namesWhere(
        [&](const Product& product) { return !stage.empty() && product.stage == stage; });
}

Names Catalogue::readBy(std::string_view stage) const {
    std::set<std::string> read;
    for (const std::string& name : madeBy(stage)) {
        const Names& parents = find(name)->parents;
        read.insert(parents.begin(), parents.end());
    }
    return namesWhere([&](const Product& product) { return read.contains(product.name); });
}

// Parents come before what is made from them, so that one way through finds all.
Names Catalogue::sources(std::string_view product) const {
    std::set<std::string, std::less<>> found{std::string(product)};
    for (auto at = products_.rbegin(); at != products_.rend(); ++at)
        if (found.contains(at->name)) found.insert(at->parents.begin(), at->parents.end());
    return namesWhere(
        [&](const Product& other) { return other.name != product && found.contains(other.name); });
}

Names Catalogue::madeFrom(std::string_view product) const {
    std::set<std::string, std::less<>> found{std::string(product)};
    for (const Product& other : products_)
        if (std::ranges::any_of(other.parents,
                                [&](const std::string& name) { return found.contains(name); }))
            found.insert(other.name);
    return namesWhere(
        [&](const Product& other) { return other.name != product && found.contains(other.name); });
}

Names Catalogue::exported() const {
    return namesWhere([](const Product& product) { return !product.endings.empty(); });
}

std::string Catalogue::keptHelp() const {
    std::string text = "Products, by the order in which they are made:\n";
    for (const Product& product : products_)
        if (product.content) text += entry(product.name, product.help, 2);
    return text;
}

std::string Catalogue::exportHelp() const {
    std::string text = "Products, and the files that they are written as:\n";
    for (const std::string& name : exported()) {
        const Product& product = *find(name);
        std::string endings;
        for (const std::string& ending : product.endings)
            endings += (endings.empty() ? "" : " ") + ending;
        text += entry(name, endings, 2) + wrapped(product.help, helpColumn, helpWidth);
    }
    return text;
}

std::string Catalogue::stageHelp() const {
    std::string text = "Stages, in their order, and the products that they make:\n";
    for (const std::string& stage : stages()) {
        text += "  " + stage + '\n';
        for (const std::string& name : madeBy(stage))
            text += entry(name, find(name)->help, 4);
    }
    return text;
}

}  // namespace haustra::store
