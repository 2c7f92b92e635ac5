// The catalogue of Haustra's products: which there are, which stage makes each, what each is made
// from and goes into, and what files they are written as. What is to know of a product but how it
// is made is said in products.cpp: prepare, export, list, the server and their --help read it.
//
// A new product has a name here and an entry there, and a stage that publishes it: either one that
// is there, or one of its own in a file of pipeline/, which is declared in pipeline/stages.h and
// has its turn in pipeline/prepare.cpp. Only a new kind of content needs more (store/content.h).
#pragma once

#include "store/content.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haustra::store {

namespace product {
inline constexpr char ct[] = "ct", source[] = "source", segmentation[] = "segmentation",
                      quality[] = "quality", mixture[] = "mixture",
                      cleansedLumen[] = "cleansed-lumen", cleansed[] = "cleansed",
                      lumen[] = "lumen", distance[] = "distance", centerline[] = "centerline",
                      branches[] = "branches", surface[] = "surface", flatMap[] = "flatmap",
                      findings[] = "findings", coverage[] = "coverage", edits[] = "edits",
                      flatImage[] = "flat-image", biopsy[] = "biopsy";
}  // namespace product

/// One product that a case can have.
struct Product {
    std::string name = {};
    /// Of prepare, that makes it; products of one stage are published under one key. Empty: what no
    /// stage makes.
    std::string stage = {};
    /// None: it is drawn anew each time that it is exported, and the store keeps nothing of it.
    std::optional<Content> content = {};
    /// Direct ones: the products that it is made from by reading them. The same for all products of
    /// one stage, since one key stands for what they are made from.
    std::vector<std::string> parents = {};
    /// Endings of the files that it is exported to, the first by preference.
    std::vector<std::string> endings = {};
    std::string help = {};  ///< one line: what it holds, in what units
    /// Readers of a case see it: with another one it is another case to them.
    bool shown = false;
};

/// Immutable: safe from any number of threads.
class Catalogue {
public:
    /// `products`: by the order in which they are made, parents before what is made from them.
    explicit Catalogue(std::vector<Product> products) : products_(std::move(products)) {}

    const std::vector<Product>& products() const { return products_; }
    /// Nullptr where there is no such product.
    const Product* find(std::string_view name) const;

    using Names = std::vector<std::string>;  // in the order of products()

    /// The stages in their order.
    Names stages() const;
    /// The products that a stage makes.
    Names madeBy(std::string_view stage) const;
    /// What a stage may read: the parents of what it makes.
    Names readBy(std::string_view stage) const;
    /// What a product depends on: its parents, theirs, and so on.
    Names sources(std::string_view product) const;
    /// What depends on a product, nearly or by way of others.
    Names madeFrom(std::string_view product) const;
    /// Products that can be exported.
    Names exported() const;
    /// For --help: of each product that the store keeps what it holds.
    std::string keptHelp() const;
    /// For --help: of each product that can be exported a line of its file endings and a line of
    /// what it holds.
    std::string exportHelp() const;
    /// For --help: of each stage its products, each with what it holds.
    std::string stageHelp() const;

private:
    template <class Condition>
    Names namesWhere(Condition condition) const;

    std::vector<Product> products_;
};

/// Haustra's products, by the order in which they are made.
const Catalogue& catalogue();

}  // namespace haustra::store
