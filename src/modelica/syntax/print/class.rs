//! Classes as text.

use super::Printer;
use crate::syntax::ast::{
    ClassDefinition, ClassElement, ClassSpecifier, DerivativeClass, Element, EnumerationClass,
    Exclusion, Extends, External, Import, ImportKind, LongClass, Purity, Restriction, Section,
    ShortClass, StoredDefinition, Visibility,
};

impl Printer {
    pub(super) fn stored_definition(&mut self, definition: &StoredDefinition) {
        if let Some(within) = &definition.within {
            self.word("within");
            if !within.node.parts.is_empty() {
                self.word(" ");
                self.show(&within.node);
            }
            self.word(";\n");
        }
        for class in &definition.classes {
            self.flag(class.is_final, "final");
            self.class(class);
            self.word(";\n");
        }
    }

    pub(super) fn class(&mut self, class: &ClassDefinition) {
        self.flag(class.encapsulated, "encapsulated");
        self.flag(class.partial, "partial");
        self.restriction(class.restriction);
        self.word(" ");
        match &class.specifier {
            ClassSpecifier::Long(long) => self.long_class(class, long),
            ClassSpecifier::Short(short) => {
                self.show(class.name.node);
                self.short_class(short);
            }
            ClassSpecifier::Enumeration(enumeration) => {
                self.show(class.name.node);
                self.enumeration(enumeration);
            }
            ClassSpecifier::Derivative(derivative) => {
                self.show(class.name.node);
                self.derivative(derivative);
            }
        }
    }

    fn restriction(&mut self, restriction: Restriction) {
        if let Restriction::Function { purity, operator } = restriction {
            self.flag(purity == Some(Purity::Pure), "pure");
            self.flag(purity == Some(Purity::Impure), "impure");
            self.flag(operator, "operator");
        }
        self.word(restriction.keyword());
    }

    fn short_class(&mut self, short: &ShortClass) {
        self.word(" = ");
        self.type_prefixes(short.prefixes);
        self.show(&short.target.name);
        self.subscripts(&short.subscripts);
        self.class_modification(&short.modification);
        self.comment(&short.comment);
    }

    fn enumeration(&mut self, enumeration: &EnumerationClass) {
        self.word(" = enumeration(");
        match &enumeration.literals {
            Some(literals) => self.list(literals, |printer, literal| {
                printer.show(literal.name.node);
                printer.comment(&literal.comment);
            }),
            None => self.word(":"),
        }
        self.word(")");
        self.comment(&enumeration.comment);
    }

    fn derivative(&mut self, derivative: &DerivativeClass) {
        self.word(" = der(");
        self.show(&derivative.target.name);
        for variable in &derivative.variables {
            self.word(", ");
            self.show(variable.node);
        }
        self.word(")");
        self.comment(&derivative.comment);
    }

    fn long_class(&mut self, class: &ClassDefinition, long: &LongClass) {
        self.flag(long.class_extends.is_some(), "extends");
        self.show(class.name.node);
        self.class_modification(long.class_extends.as_deref().unwrap_or_default());
        self.description(long.description.as_deref());
        long.sections.iter().for_each(|section| self.section(section));
        self.new_line();
        self.word("end ");
        self.show(long.end_name.node);
    }

    fn section(&mut self, section: &Section) {
        match section {
            Section::Elements { visibility, elements } => {
                if let Some(visibility) = visibility {
                    self.heading(match visibility {
                        Visibility::Public => "public",
                        Visibility::Protected => "protected",
                    });
                }
                self.lines(elements, Printer::element);
            }
            Section::Equations { initial, equations, .. } => {
                self.heading(if *initial { "initial equation" } else { "equation" });
                self.lines(equations, Printer::equation);
            }
            Section::Algorithm { initial, statements, .. } => {
                self.heading(if *initial { "initial algorithm" } else { "algorithm" });
                self.lines(statements, Printer::statement);
            }
            Section::External(external) => {
                self.lines(std::slice::from_ref(external), Printer::external);
            }
            Section::Annotation(annotation) => {
                self.lines(std::slice::from_ref(annotation), Printer::annotation);
            }
        }
    }

    fn heading(&mut self, keyword: &str) {
        self.new_line();
        self.word(keyword);
    }

    fn lines<T>(&mut self, items: &[T], item: fn(&mut Printer, &T)) {
        self.indented(|printer| {
            for one in items {
                printer.new_line();
                item(printer, one);
                printer.word(";");
            }
        });
    }

    fn external(&mut self, external: &External) {
        self.word("external");
        self.description(external.language.as_deref());
        if let Some(output) = &external.output {
            self.word(" ");
            self.reference(output);
            self.word(" =");
        }
        if let Some(function) = &external.function {
            self.word(" ");
            self.show(function.node);
            self.word("(");
            self.list(&external.arguments, Printer::expression);
            self.word(")");
        }
        if let Some(annotation) = &external.annotation {
            self.word(" ");
            self.annotation(annotation);
        }
    }

    fn element(&mut self, element: &Element) {
        match element {
            Element::Import(import) => self.import(import),
            Element::Extends(extends) => self.extends(extends),
            Element::Class(class) => self.class_element(class),
            Element::Component(clause) => self.component_clause(clause),
        }
    }

    fn class_element(&mut self, element: &ClassElement) {
        self.element_prefixes(element.prefixes);
        self.class(&element.class);
        self.constraint(element.constraint.as_ref());
    }

    pub(super) fn import(&mut self, import: &Import) {
        self.word("import ");
        match &import.kind {
            ImportKind::Qualified(name) => self.show(name),
            ImportKind::Renaming(alias, name) => {
                self.show(alias);
                self.word(" = ");
                self.show(name);
            }
            ImportKind::Unqualified(name) => {
                self.show(name);
                self.word(".*");
            }
            ImportKind::Group(name, members) => {
                self.show(name);
                self.word(".{");
                self.list(members, |printer, member| printer.show(member));
                self.word("}");
            }
        }
        self.comment(&import.comment);
    }

    fn extends(&mut self, extends: &Extends) {
        self.word("extends ");
        self.show(&extends.base.name);
        if !extends.modification.is_empty() || !extends.excluded.is_empty() {
            self.word("(");
            self.list(&extends.modification, Printer::argument);
            if !extends.modification.is_empty() && !extends.excluded.is_empty() {
                self.word(", ");
            }
            self.list(&extends.excluded, Printer::exclusion);
            self.word(")");
        }
        if let Some(annotation) = &extends.annotation {
            self.word(" ");
            self.annotation(annotation);
        }
    }

    fn exclusion(&mut self, exclusion: &Exclusion) {
        self.word("break ");
        match exclusion {
            Exclusion::Component(name) => self.show(name.node),
            Exclusion::Connection(left, right) => {
                self.word("connect(");
                self.reference(left);
                self.word(", ");
                self.reference(right);
                self.word(")");
            }
        }
    }
}
