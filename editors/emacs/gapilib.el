;;; gapilib.el --- Modelica and GAPILib scripts -*- lexical-binding: t -*-

;;; Commentary:

;; Modes for Modelica files and scripts, with the language server of gapilib by Eglot, which is part of
;; Emacs 29.

;;; Code:

(defgroup gapilib nil "Modelica and GAPILib scripts." :group 'languages)

(defcustom gapilib-program "gapi"
  "The program gapi."
  :type 'string)

(defcustom gapilib-libraries nil
  "Folders with Modelica packages, besides those of MODELICAPATH."
  :type '(repeat directory))

(defconst gapilib-keywords
  '("algorithm" "and" "annotation" "block" "break" "class" "connect" "connector" "constant"
    "constrainedby" "der" "discrete" "each" "else" "elseif" "elsewhen" "encapsulated" "end" "enumeration"
    "equation" "expandable" "extends" "external" "false" "final" "flow" "for" "function" "if" "import"
    "impure" "in" "initial" "inner" "input" "loop" "model" "not" "operator" "or" "outer" "output"
    "package" "parameter" "partial" "protected" "public" "pure" "record" "redeclare" "replaceable"
    "return" "stream" "then" "true" "type" "when" "while" "within"))

(defvar gapilib-font-lock
  `((,(concat "\\_<" (regexp-opt gapilib-keywords t) "\\_>") . font-lock-keyword-face)
    ("\\_<\\(Real\\|Integer\\|Boolean\\|String\\)\\_>" . font-lock-type-face)))

(defvar gapilib-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?_ "_" table)
    (modify-syntax-entry ?' "\"" table)
    (modify-syntax-entry ?\" "\"" table)
    table))

;;;###autoload
(define-derived-mode gapilib-modelica-mode prog-mode "Modelica"
  "Modelica files."
  :syntax-table gapilib-syntax-table
  (setq-local comment-start "// ")
  (setq-local comment-end "")
  (setq-local indent-tabs-mode nil)
  (setq-local tab-width 2)
  (setq-local font-lock-defaults '(gapilib-font-lock)))

;;;###autoload
(define-derived-mode gapilib-script-mode gapilib-modelica-mode "Modelica script"
  "Scripts of Dymola, OpenModelica and GAPILib.")

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.mo\\'" . gapilib-modelica-mode))
;;;###autoload
(add-to-list 'auto-mode-alist '("\\.mos\\'" . gapilib-script-mode))

(defun gapilib-command (&rest _)
  "The command that starts the language server."
  (append (list gapilib-program "lsp")
          (mapcan (lambda (folder) (list "--library" (expand-file-name folder)))
                  (copy-sequence gapilib-libraries))))

(defvar eglot-server-programs)

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs
               '((gapilib-modelica-mode gapilib-script-mode) . gapilib-command)))

(defun gapilib-run ()
  "Run the script of this buffer."
  (interactive)
  (save-buffer)
  (compile (format "%s run %s" (shell-quote-argument gapilib-program)
                   (shell-quote-argument (buffer-file-name)))))

(provide 'gapilib)
;;; gapilib.el ends here
